# bash completion of Palp's programs: verbs, options and the names they take, as --help lists them
_palp() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local program=${COMP_WORDS[0]} verb="" word help candidates
  COMPREPLY=()
  help=$("$program" --help 2>/dev/null) || return
  local verbs
  verbs=$(command sed -n '/^Verbs:/,/^$/s/^  \([a-z][a-z-]*\).*/\1/p' <<<"$help")
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if command grep -qxF -e "$word" <<<"$verbs"; then verb=$word; fi
  done
  [ -n "$verb" ] && help+=$'\n'$("$program" "$verb" --help 2>/dev/null)
  case $current in
    -*) candidates=$(command sed -n 's/^  \(-h,\)\{0,1\}\(--[a-z][a-z-]*\).*/\2/p' <<<"$help") ;;
    *)
      case $before in
        --preset) candidates=$(palp-netem presets 2>/dev/null |
          command sed -n 's/^\([a-z0-9-]*\):.*/\1/p') ;;
        --set | run) candidates=$([ "$program" != palp-lab ] || palp-lab scenarios 2>/dev/null |
          command awk '{print $1}') ;;
        --coupling) candidates="direct wave tdpa mmt" ;;
        --style) candidates="screen single double" ;;
        --grip) candidates="light mid firm arm" ;;
        --rule) candidates="gp raster" ;;
        --phantom) candidates="paper-5mm paper-10mm paper-15mm paper-20mm paper-25mm none" ;;
        --master) candidates="script:standard script:demo script:map script:search \
          script:breath script:long pointer" ;;
        *) [ -n "$verb" ] || candidates=$verbs ;;
      esac
      ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "${candidates-}" -- "$current")
  __ltrim_colon_completions "$current" 2>/dev/null
}
complete -o default -F _palp palp-surgeon palp-patient palp-lab palp-review palp-netem palp-fem \
  palp-relay palp-study
