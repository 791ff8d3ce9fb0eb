#!/usr/bin/env bash
# Installs the Debian packages of apt_packages.txt that are missing. Without any it changes nothing
# and needs neither network nor rights.
set -euo pipefail

list=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/apt_packages.txt

fail() {
  printf 'install_dependencies.sh: %s\n' "$@" >&2
  exit 1
}

mapfile -t wanted < <(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$list")
command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
  fail "this is not Debian; install the counterparts of these packages by hand:" "${wanted[*]}"

mapfile -t missing < <(
  comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) \
    <(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p' | sort -u)
)
[[ ${#missing[@]} -gt 0 ]] || exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null ||
    fail "packages are missing and there is no sudo; as root run:" \
      "  apt-get install --no-install-recommends ${missing[*]}"
  as_root=(sudo)
fi
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --quiet --quiet)

echo "Installing ${#missing[@]} packages: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
"${apt[@]}" update </dev/null >"$log" 2>&1 || true # an old list may still do
if ! "${apt[@]}" install --yes --no-install-recommends "${missing[@]}" </dev/null >>"$log" 2>&1; then
  tail -n 20 "$log" >&2
  fail "these packages could not be installed (apt's words stand above): ${missing[*]}" \
    "Furrow is built on Debian 12; the package archive must be within reach the first time."
fi
