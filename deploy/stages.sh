# For scripts, sourced by them: how long each of their stages took.

stage_names=""
stage_began=""

# stage NAME: ends the stage before it and begins this one.
stage() {
  end_stage
  stage_now="$1"
  stage_began="$(date +%s)"
}
end_stage() {
  [ -n "$stage_began" ] || return 0
  stage_names="$stage_names$(printf '%-10s %6.1f min' "$stage_now" "$(awk "BEGIN {print ($(date +%s) - $stage_began) / 60}")")
"
  stage_began=""
}
# Ends the last stage and prints the table.
print_stages() {
  end_stage
  printf '\n== minutes by stage, on %s processors\n%s' "$(nproc)" "$stage_names"
}
