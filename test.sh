#!/usr/bin/env bash
# Builds and checks everything, as continuous integration does, and closes with the counts.
#   ./test.sh            all that CI runs (about 25 minutes on two cores)
#   ./test.sh --quick    release build and its tests only
#   ./test.sh STEP …     chosen steps: format release asan tsan aarch64 fuzz bench soak vm,
#                        and tidy, analyze
# FUZZ_SECONDS (20) is the time of a fuzz target (scripts/run-fuzzer.sh).
set -uo pipefail
cd "$(dirname "$0")"

case "${1:-}" in
  -h | --help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
  --quick) steps=(format release) ;;
  "") steps=(format release asan tsan aarch64 fuzz bench soak vm) ;;
  *) steps=("$@") ;;
esac

scripts/install-packages.sh test || exit 1
logs=build/logs
mkdir -p "$logs"
passed=0 failed=0 skipped=0
declare -a failures=()
declare -A begun=()
trap 'kill $(jobs -p) 2>/dev/null' EXIT

# begin NAME COMMAND…: what check NAME is going to ask for, while tests that mostly wait leave the processors idle.
begin() {
  local name=$1
  shift
  (renice -n 19 $BASHPID && exec "$@") >"$logs/$name.log" 2>&1 &
  begun[$name]=$!
}

# check NAME COMMAND…: one check of its own; its output is shown only when it fails.
check() {
  local name=$1 started=$SECONDS
  shift
  if [ -n "${begun[$name]:-}" ]; then set -- wait "${begun[$name]}"; else : >"$logs/$name.log"; fi
  if "$@" >>"$logs/$name.log" 2>&1; then
    passed=$((passed + 1))
    echo "ok      $name ($((SECONDS - started)) s)"
  else
    failed=$((failed + 1))
    failures+=("$name: $logs/$name.log")
    echo "FAILED  $name ($((SECONDS - started)) s), the end of $logs/$name.log:"
    tail -n 40 "$logs/$name.log" | sed 's/^/        /'
    return 1
  fi
}

# cases_of PRESET FILE: what GoogleTest says of each case, whether ctest runs it alone or with its program.
cases_of() {
  sed -nE 's/^\[ +(OK|FAILED|SKIPPED) +\] ([^ ,]*).* \([0-9]+ ms\)$/\1 \2/p' "build/$1/Testing/Temporary/LastTest.log" >"$2"
}

# only_programs_failed PRESET: all tests that failed have the label `programs` (cmake/Targets.cmake).
only_programs_failed() {
  ! sed 's/^[0-9]*://' "build/$1/Testing/Temporary/LastTestsFailed.log" |
    grep -qvxFf <(ctest --test-dir "build/$1" -N -L '^programs$' | sed -n 's/^ *Test *#[0-9]*: //p')
}

# that_failed PRESET: a regular expression of the names of the tests that failed. Not ctest's own --rerun-failed: that
# goes by numbers, which -E shifts.
that_failed() {
  sed -E 's/^[0-9]*://; s/[][().*+?^$|\\]/\\&/g; s/.*/^&$/' "build/$1/Testing/Temporary/LastTestsFailed.log" | paste -s -d '|'
}

# ctest_preset PRESET [ctest options]: adds the counts of test cases to ours.
ctest_preset() {
  local preset=$1 log="$logs/ctest-$1.log" started=$SECONDS status cases total bad skip
  shift
  # Three at a time: the programs mostly wait.
  ctest --test-dir "build/$preset" -j 3 --output-on-failure "$@" >"$log" 2>&1
  status=$?
  cases=$logs/cases-$preset.txt
  cases_of "$preset" "$cases"
  # Programs that run live say nothing when the host holds up the sensors that are played to them (what is written to a
  # terminal waits for a work queue of the kernel, beside what is written to disks): what fails of these is run again,
  # alone, at most twice, and has to pass then. Not what a sanitizer has found: a race need not come twice.
  for again in 1 2; do
    if [ $status = 0 ] || grep -qE 'runtime error:|Sanitizer' "$log" || ! only_programs_failed "$preset"; then break; fi
    log=$logs/ctest-$preset-again-$again.log
    ctest --test-dir "build/$preset" -R "$(that_failed "$preset")" --output-on-failure >"$log" 2>&1
    status=$?
    cases_of "$preset" "$cases.again"
    echo "        failed beside others, and run again alone: $(tr '\n' ' ' <"$cases.again")(before: $logs/ctest-$preset*.log)"
    awk 'NR == FNR { again[$2] = 1; print; next } !($2 in again)' "$cases.again" "$cases" >"$cases.all"
    mv "$cases.all" "$cases"
  done
  total=$(wc -l <"$cases") bad=$(grep -c ^FAILED "$cases") skip=$(grep -c ^SKIPPED "$cases")
  # A crash or a timeout fails without a case that says so.
  [ $status = 0 ] || [ "$bad" != 0 ] || { bad=1 total=$((total + 1)); }
  if [ "$total" = 0 ]; then
    bad=1 total=1
    echo "no test ran" >>"$log"
  fi
  passed=$((passed + total - skip - bad)) failed=$((failed + bad)) skipped=$((skipped + skip))
  echo "$([ "$bad" = 0 ] && echo 'ok     ' || echo 'FAILED ') tests of $preset: $((total - skip - bad)) passed, $bad failed, $skip skipped ($((SECONDS - started)) s)"
  [ "$skip" = 0 ] || echo "        skipped: $(sed -n 's/^SKIPPED //p' "$cases" | tr '\n' ' ')"
  if [ "$bad" != 0 ]; then
    failures+=("tests of $preset: $log")
    grep -E '\*\*\*(Failed|Timeout|Exception)|Subprocess aborted|^no test ran' "$log" | head -n 20 | sed 's/^/        /'
    grep -E -A 5 ': Failure$|runtime error:|ERROR: .*Sanitizer' "$log" | cut -c 1-300 | head -n 40 | sed 's/^/        /'
  fi
}

# build_preset PRESET [-D…] [--target NAME]
build_preset() {
  local preset=$1 defines=() target=all
  shift
  while [ $# -gt 0 ]; do
    case "$1" in
      --target) target=$2; shift 2 ;;
      *) defines+=("$1"); shift ;;
    esac
  done
  cmake --preset "$preset" -DCONVEXCUT_UNITY=ON "${defines[@]}" && cmake --build --preset "$preset" --target "$target" -j 2
}

# guest_checks: the release build in a guest (tests/vm), whose checks are added to ours.
guest_checks() {
  local log="$logs/vm.log" status
  [ -z "${begun[guest]:-}" ] || wait "${begun[guest]}"
  scripts/install-packages.sh vm || echo "        packages of the guest cannot be installed"
  tests/vm/run.sh 2>&1 | tee "$log"
  status=${PIPESTATUS[0]}
  passed=$((passed + $(grep -c '^ok ' "$log")))
  case $status in
    0) echo "ok      vm: $(grep -c '^ok ' "$log") checks in the guest" ;;
    77) skipped=$((skipped + 1)) ;;
    *)
      failed=$((failed + 1))
      failures+=("vm: $log")
      ;;
  esac
}

# soak SECONDS: the live daemon with nothing lost, nothing late, nothing allocated. On a busy host a run in which the
# sensors themselves were held up says nothing: three tries.
soak() {
  build/release/bin/convexcut-demo-room --seconds 10 --imu-rate-hz 400 --imu-baud 460800 --out build/soak-room || return 1
  for _ in 1 2 3; do
    REPLAY_ARGS="--from 1 --to 9" CONVEXCUTD_ARGS="--set imu.configure=true" \
      tests/soak.sh build/soak-room/lidar.pcap build/soak-room/imu.pcap "$1" && return 0
  done
  return 1
}

for step in "${steps[@]}"; do
  case "$step" in
    format) check format scripts/check-format.sh ;;
    release)
      if check build-release build_preset release; then
        [[ " ${steps[*]} " != *" aarch64 "* ]] || begin build-aarch64 scripts/check-aarch64.sh build
        ctest_preset release
      fi
      ;;
    # Not what differs from another test in what is judged, not in the code that runs.
    asan)
      if check build-asan build_preset asan -DCONVEXCUT_BENCH=OFF; then
        [[ " ${steps[*]} " != *" vm "* ]] || begin guest tests/vm/make-rootfs.sh
        ctest_preset asan -E 'HoldsUpNobody/best_effort|PacketLoss.*/Of01|Rotor.*/(9|20)$|replay_robust_test|ProcessedGivesTheOrientations'
      fi
      ;;
    # Only what runs on several threads: the other tests cannot race. The largest cloud and the paths of the kernels,
    # on which threads work in the same way, would be half of the time.
    tsan)
      check build-tsan build_preset tsan -DCONVEXCUT_BENCH=OFF --target threads_tests &&
        ctest_preset tsan -L threads -E 'RoomPanorama|EverySimdPath'
      ;;
    aarch64) check build-aarch64 scripts/check-aarch64.sh build && ctest_preset aarch64 ;;
    fuzz)
      if check build-fuzz build_preset fuzz --target fuzz_targets; then
        for target in build/fuzz/fuzz/fuzz_*; do
          echo "$target"
        done | xargs -P 2 -n 1 scripts/run-fuzzer.sh "${FUZZ_SECONDS:-20}"
        for target in build/fuzz/fuzz/fuzz_*; do
          check "$(basename "$target")" scripts/run-fuzzer.sh --result "$target"
        done
      fi
      ;;
    bench)
      check instructions scripts/check-instructions.sh && sed -n 's/^figure: /        /p' "$logs/instructions.log"
      check bench scripts/check-ratios.sh && sed -n 's/^figure: /        /p' "$logs/bench.log"
      ;;
    soak) check build-for-soak build_preset release && check soak soak 20 && sed -n 's/^packets_sent/        &/p' "$logs/soak.log" ;;
    vm) check build-for-vm build_preset release && guest_checks ;;
    tidy) check tidy scripts/check-tidy.sh ;;
    analyze) check analyze scripts/check-tidy.sh analyze ;;
    *) echo "test.sh: unknown step '$step': expected format release asan tsan aarch64 fuzz bench soak vm tidy analyze" >&2; exit 2 ;;
  esac
done

for failure in "${failures[@]}"; do echo "failed: $failure"; done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ]
