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
    return 1
  fi
}

# The system's clock is stepped here: spans are measured without it.
uptime_s() { cut -d. -f1 /proc/uptime; }

# within SECONDS COMMAND…: until the command succeeds.
within() {
  local end=$(($(uptime_s) + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ "$(uptime_s)" -lt $end ] || { echo "not within the time: $*"; "$@"; return 1; }
    sleep 0.1
  done
}

# gtest PROGRAM [arguments]: each of its tests is a check; a skipped one has failed: here is what it asks for.
gtest() {
  local program=$1 log=out/$1.log name
  "$@" >"$log" 2>&1
  local status=$? count=0
  while read -r name; do
    count=$((count + 1))
    check "$program $name" grep -qF "[       OK ] $name (" "$log"
  done < <(sed -n 's/^\[ RUN      \] //p' "$log")
  check "$program ran its tests and ended well" [ $status = 0 -a $count -gt 0 ]
  [ $status = 0 ] || grep -vE '^\[ (RUN|      OK) ' "$log" | tail -n 60 | sed 's/^/        /'
}

# The daemon and who watches it. said TEXT: in the daemon's log since it was last marked.
start_daemon() {
  convexcutd "$@" 2>>out/daemon.log &
  daemon=$!
}
mark() { marked=$(wc -l <out/daemon.log); }
said() { tail -n +$((marked + 1)) out/daemon.log | grep -q -- "$1" || { tail -n 20 out/daemon.log; return 1; }; }
# Not within a check, which cannot wait for it.
stop_daemon() {
  kill -TERM $daemon
  wait $daemon
  stopped=$?
}
start_watch() {
  convexcut watch --json >out/watch.log 2>&1 &
  watch=$!
}
watched() { wc -l <out/watch.log; }
# of LINE KEY: a number of one second of `convexcut watch`.
of() { sed -n "$1s/.*\"$2\": *\([0-9.]*\).*/\1/p" out/watch.log; }
# is KEY OPERATOR NUMBER: in the last second.
is() {
  awk -v found="$(of '$' "$1")" -v limit="$3" "BEGIN { exit !(found != \"\" && found + 0 $2 limit + 0) }" ||
    { tail -n 3 out/watch.log; return 1; }
}
