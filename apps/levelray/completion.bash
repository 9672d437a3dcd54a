# Bash completion for levelray: asks the program itself, so that there is no second list of its options.

_levelray() {
  local word=${COMP_WORDS[COMP_CWORD]} help
  if ((COMP_CWORD == 1)); then
    help=$("${COMP_WORDS[0]}" --help 2>/dev/null) || return
    # Under "Subcommands:", two spaces and the name.
    mapfile -t COMPREPLY < <(compgen -W "$(sed -n '/^Subcommands:/,$ s/^  \([a-z]\+\).*/\1/p' <<<"$help") --help --version" -- "$word")
  elif [[ $word == -* ]]; then
    help=$("${COMP_WORDS[0]}" "${COMP_WORDS[1]}" --help 2>/dev/null) || return
    mapfile -t COMPREPLY < <(compgen -W "$(sed -n 's/^  [^ ]*\(--[a-z-]\+\).*/\1/p' <<<"$help" | sort -u)" -- "$word")
  fi
}
complete -o default -F _levelray levelray
