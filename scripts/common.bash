# Sourced by the other scripts; the working directory is the root of the package.

# A new system may have no other locale.
export LC_ALL=C.UTF-8
export PYTHONDONTWRITEBYTECODE=1

fail() {
  echo "error: $*" >&2
  exit 1
}

# quietly LOG COMMAND...: the command's output goes to LOG; its end is shown if the command fails.
quietly() {
  local log=$1
  shift
  mkdir -p "$(dirname "$log")"
  if ! "$@" >"$log" 2>&1 </dev/null; then
    tail -n 30 "$log" >&2
    echo "error: '$*' failed; all of its output is in $log" >&2
    return 1
  fi
}
