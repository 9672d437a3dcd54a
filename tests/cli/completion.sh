#!/bin/bash
# The bash completion offers what the program knows. Usage: completion.sh PROGRAM COMPLETION
set -euo pipefail
program=$1
source "$2"

expect() { # expect WANTED WORD...: completing the last WORD offers WANTED and nothing that does not begin with it
  local wanted=$1 offer
  COMP_WORDS=("$program" "${@:2}")
  COMP_CWORD=$(($# - 1))
  COMPREPLY=()
  _levelray
  printf '%s: %s\n' "${*:2}" "${COMPREPLY[*]}"
  for offer in "${COMPREPLY[@]}"; do
    [[ $offer == "${!#}"* ]] || { echo "offers $offer for ${!#}"; exit 1; }
  done
  [[ " ${COMPREPLY[*]} " == *" $wanted "* ]] || { echo "does not offer $wanted"; exit 1; }
}

expect convert ""
expect render r
expect info in
expect compare co
expect farm fa
expect --chunk farm slurm --c
expect --hardfail compare a.exr b.exr --h
expect --resolution convert --res
expect --sign convert in.obj out.vdb --
expect --intersector render in.vdb --i
expect --shadows render --sh
expect --json info --
