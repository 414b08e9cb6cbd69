# Sourced by the scripts beside it, whose first argument is the folder of the programs. Gives
#   $bin, $work    that folder; a folder of the script's own, gone at its end unless PALP_KEEP is it
#   background     programs that are stopped when the script ends
#   address_in     where a program listens, from its log
#   make_keys      an identity for each site, in $work/keys
#   fail           a sentence, the ends of all logs, exit code 1
set -u
bin=$(cd "${1:?the folder of the programs}" && pwd) || exit 3
work=${PALP_KEEP:-$(mktemp -d)}
mkdir -p "$work"
script=$(basename "$0")
running=()

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
make_keys() {
  "$bin/palp-surgeon" certificates --folder "$work/keys" >"$work/keys.log" 2>&1 || fail "no keys"
}
