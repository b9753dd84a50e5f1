# Sourced by run.sh in the guest: what all checks use.
passed=0 failed=0

# check NAME COMMAND…: one line a check; the command's output is shown only when it fails.
check() {
  local name=$1 output
  shift
  if output=$("$@" 2>&1); then
    passed=$((passed + 1))
    echo "ok      $name"
  else
    failed=$((failed + 1))
    echo "FAILED  $name"
    echo "$output" | tail -n 30 | sed 's/^/        /'
  fi
}

# within SECONDS COMMAND…: until the command succeeds.
within() {
  local tenths=$(($1 * 10))
  shift
  until "$@" >/dev/null 2>&1; do
    tenths=$((tenths - 1))
    [ $tenths -gt 0 ] || { echo "not within the time: $*"; return 1; }
    sleep 0.1
  done
}

# gtest PROGRAM [arguments]: each of its tests is a check; a skipped one has failed: here is what it asks for.
gtest() {
  local program=$1 log=out/$1.log name
  shift
  "./$program" "$@" >"$log" 2>&1
  local status=$? count=0
  while read -r name; do
    count=$((count + 1))
    check "$program $name" grep -qF "[       OK ] $name (" "$log"
  done < <(sed -n 's/^\[ RUN      \] //p' "$log")
  check "$program ran its tests and ended well" [ $status = 0 -a $count -gt 0 ]
  [ $status = 0 ] || grep -vE '^\[ (RUN|      OK) ' "$log" | tail -n 60 | sed 's/^/        /'
}
