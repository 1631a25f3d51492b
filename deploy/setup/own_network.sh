#!/usr/bin/env bash
# Run a command in a network of its own, in which nothing but loopback exists: own_network.sh COMMAND...
# Where that is not allowed (some containers), it runs in the network of this machine.
set -euo pipefail
alone=(unshare --net --map-root-user)
loopback='ip link set lo up && ip link set lo multicast on'
if "${alone[@]}" bash -c "$loopback" 2>/dev/null; then
    exec "${alone[@]}" bash -c "$loopback"' && exec "$@"' bash "$@"
fi
echo "No network of its own for ROS here (unshare --net, iproute2): other robots of its domain may be heard." >&2
exec "$@"
