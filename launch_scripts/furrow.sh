# To be sourced: the project's root, and the `furrow` command that was built there.

furrow_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

furrow() {
  local program=$furrow_root/install/furrow_cli/bin/furrow
  [[ -x $program ]] || program=$furrow_root/install/bin/furrow # colcon's --merge-install
  if [[ ! -x $program ]]; then
    echo "$(basename "$0"): Furrow is not built yet; run $furrow_root/launch_scripts/build.sh" >&2
    return 2
  fi
  "$program" "$@"
}

# Whether an option is among the arguments, as `--name value` or `--name=value`.
has_option() {
  local option=$1 argument
  shift
  for argument in "$@"; do
    [[ $argument == "$option" || $argument == "$option="* ]] && return 0
  done
  return 1
}
