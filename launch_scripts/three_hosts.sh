#!/usr/bin/env bash
# Runs the weeding graph on three hosts: vision, planning, actuation. The hosts are network
# namespaces of this machine, joined by a bridge. Each has its own address, host name and shared
# memory. The script makes and removes them and the bridge; nothing leaves the machine.
#
# usage: three_hosts.sh [--discovery multicast|static_peers|discovery_server] [option of furrow up]...
#
# FURROW_CUT="HOST AFTER_S FOR_S" takes the link of a host down once, to see what the others do.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/furrow.sh"
program=$furrow_root/install/furrow_cli/bin/furrow
[[ -x $program ]] || program=$furrow_root/install/bin/furrow
program=${FURROW_PROGRAM:-$program}

die() {
  echo "three_hosts.sh: $*" >&2
  exit 2
}

discovery=multicast
if [[ ${1:-} == --discovery ]]; then
  discovery=${2:-}
  shift 2 || die "--discovery needs a value"
fi
case $discovery in
  multicast | static_peers | discovery_server) ;;
  *) die "--discovery is multicast, static_peers or discovery_server" ;;
esac
[[ -x $program ]] || die "Furrow is not built yet; run launch_scripts/build.sh"
for tool in ip unshare mount; do
  command -v "$tool" >/dev/null || die "needs the program '$tool' (packages iproute2, util-linux)"
done
[[ $(id -u) == 0 ]] || die "makes network namespaces, for which it needs root: run it with sudo"

hosts=(vision planning actuation)
id=$$
bridge=fwb$id
namespace() { echo "furrow_$1_$id"; }

pids=()
clean_up() {
  trap '' INT TERM
  for pid in "${pids[@]}"; do kill -TERM "$pid" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
  for host in "${hosts[@]}"; do ip netns del "$(namespace "$host")" 2>/dev/null || true; done
  ip netns del "furrow_switch_$id" 2>/dev/null || true
}
trap clean_up EXIT
trap 'exit 130' INT TERM

# The bridge stands in a namespace of its own, so that the machine's own network stays as it is.
ip netns add "furrow_switch_$id" 2>/dev/null ||
  die "may not make network namespaces: run it on the machine itself or in a privileged container"
switch=(ip netns exec "furrow_switch_$id")
"${switch[@]}" ip link add "$bridge" type bridge
"${switch[@]}" ip link set "$bridge" up
number=0
for host in "${hosts[@]}"; do
  number=$((number + 1))
  name=$(namespace "$host")
  ip netns add "$name"
  ip -n "$name" link set lo up
  ip -n "$name" link add eth0 type veth peer name "port$number" netns "furrow_switch_$id"
  ip -n "$name" addr add "192.168.173.$number/24" dev eth0
  ip -n "$name" link set eth0 up
  # Discovery by multicast has to know where it goes.
  ip -n "$name" route add 224.0.0.0/4 dev eth0
  "${switch[@]}" ip link set "port$number" master "$bridge" up
done

for host in "${hosts[@]}"; do
  # A host name and a /dev/shm of its own, as another machine would have.
  ip netns exec "$(namespace "$host")" unshare --uts --mount bash -c '
    hostname "$1" && mount -t tmpfs tmpfs /dev/shm && shift && exec "$@"' _ "$host" \
    "$program" up --deploy three_hosts --host "$host" \
    --dds "discovery=$discovery" "$@" &
  pids+=($!)
done

if [[ -n ${FURROW_CUT:-} ]]; then
  read -r cut_host cut_after cut_for <<<"$FURROW_CUT"
  (
    sleep "$cut_after"
    ip -n "$(namespace "$cut_host")" link set eth0 down
    sleep "$cut_for"
    ip -n "$(namespace "$cut_host")" link set eth0 up
    ip -n "$(namespace "$cut_host")" route add 224.0.0.0/4 dev eth0
  ) &
fi

result=0
for pid in "${pids[@]}"; do
  wait "$pid" || result=$?
done
pids=()
exit "$result"
