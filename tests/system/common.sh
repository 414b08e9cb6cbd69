# Sourced by the scripts beside it, whose first argument is the folder of the programs. Gives
#   $bin, $work    that folder; a folder of the script's own, gone at its end unless PALP_KEEP is it
#   background     programs that are stopped when the script ends
#   address_in     where a program listens, from its log
#   make_keys      an identity for each site, in $work/keys
#   fence          what a page shows between ```LANGUAGE and ```
#   fail           a sentence, the ends of all logs, exit code 1
#   watch_machine  from now on, notes how long the machine stands still
#   standstill     the longest time that it stood still since, in whole ms; ends the watch
set -u
bin=$(cd "${1:?the folder of the programs}" && pwd) || exit 3
work=${PALP_KEEP:-$(mktemp -d)}
mkdir -p "$work"
script=$(basename "$0")
running=()
watching=()

background() { # log command...: $! is its number
  local log=$1
  shift
  "$@" >"$log" 2>&1 &
  running+=("$!")
}
stop_all() {
  for program in ${running[@]+"${running[@]}"}; do kill "$program" 2>/dev/null; done
  wait 2>/dev/null
}
clean() {
  # First, because stop_all waits for everything that runs.
  [ ${#watching[@]} -eq 0 ] || standstill >/dev/null
  stop_all
  [ -n "${PALP_KEEP-}" ] || rm -rf "$work"
}
trap clean EXIT
fail() {
  echo "$script: $1"
  tail -n 20 "$work"/*.log
  exit 1
}
address_in() { # log
  for _ in $(seq 1 200); do
    sed -n 's/^listening on \([^ ,]*\).*/\1/p' "$1" 2>/dev/null | grep -m 1 . && return
    sleep 0.05
  done
  return 1
}
fence() { # page language
  sed -n "/^\`\`\`$2\$/,/^\`\`\`\$/p" "$1" | sed '1d;$d'
}
make_keys() {
  "$bin/palp-surgeon" certificates --folder "$work/keys" >"$work/keys.log" 2>&1 || fail "no keys"
}
# On a shared machine a processor may stand still for a tenth of a second: what a site says of such
# a run is not the network's doing.
watch_machine() {
  local cpu
  rm -f "$work"/standstill.*
  for cpu in $(seq 0 $(($(nproc) - 1))); do
    taskset -c "$cpu" python3 - >"$work/standstill.$cpu" 2>/dev/null <<'END' &
import signal, sys, time
longest, before = 0.0, time.monotonic()
def end(*_):
    print(round(1e3 * longest))
    sys.exit()
signal.signal(signal.SIGTERM, end)
while True:
    time.sleep(0.002)
    now = time.monotonic()
    longest, before = max(longest, now - before), now
END
    watching+=("$!")
  done
}
standstill() {
  kill "${watching[@]}" 2>/dev/null
  wait "${watching[@]}" 2>/dev/null
  watching=()
  sort -n "$work"/standstill.* | tail -n 1
}
