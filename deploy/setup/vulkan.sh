#!/usr/bin/env bash
# Make sure that SAPIEN finds a Vulkan device with VK_KHR_external_semaphore_fd.
#
# Mesa's software driver (lavapipe) has it from 24.3 on, and every current NVIDIA driver has it.
# As root on Debian or Ubuntu the driver is installed here; otherwise the exact command is printed.
# TOPNAV_SKIP_VULKAN=1 skips all this, for machines that only run the services without a simulator.
set -euo pipefail
needed="24.3"
backports_list="${TOPNAV_BACKPORTS_LIST:-/etc/apt/sources.list.d/topnav-backports.list}"
os_release="${TOPNAV_OS_RELEASE:-/etc/os-release}"
nvidia_version="${TOPNAV_NVIDIA_VERSION:-/proc/driver/nvidia/version}"

[ "${TOPNAV_SKIP_VULKAN:-}" = 1 ] && exit 0
[ -e "$nvidia_version" ] && exit 0

new_enough() { [ -n "$1" ] && [ "$1" != "(none)" ] && dpkg --compare-versions "$1" ge "$needed"; }
installed() { dpkg-query -W -f '${db:Status-Status} ${Version}' mesa-vulkan-drivers 2>/dev/null | sed -n 's/^installed //p' || true; }
offered() { apt-cache policy mesa-vulkan-drivers | sed -n 's/^ *Candidate: *//p'; }

if ! command -v dpkg >/dev/null || ! command -v apt-get >/dev/null; then
    # Not Debian or Ubuntu: a driver may well be there, and `topnav doctor` renders to find out.
    echo "Install Mesa's Vulkan driver $needed or newer with your package manager if 'topnav doctor' asks for it." >&2
    exit 0
fi
new_enough "$(installed)" && exit 0

# shellcheck source=/dev/null
codename="$(. "$os_release" && echo "${VERSION_CODENAME:-}")"
install="apt-get install -y mesa-vulkan-drivers libvulkan1"
backports="apt-get install -y -t bookworm-backports mesa-vulkan-drivers libvulkan1"
source="deb http://deb.debian.org/debian bookworm-backports main"

if [ "$(id -u)" -ne 0 ]; then
    echo "SAPIEN needs Mesa's Vulkan driver $needed or newer. Run this, then 'make setup' again:" >&2
    if [ "$codename" = bookworm ]; then
        echo "  echo '$source' | sudo tee $backports_list && sudo apt-get update && sudo $backports" >&2
    else
        echo "  sudo apt-get update && sudo $install" >&2
    fi
    exit 1
fi

export DEBIAN_FRONTEND=noninteractive
apt-get update -q
if new_enough "$(offered)"; then
    $install
elif [ "$codename" = bookworm ]; then
    grep -rqs "bookworm-backports" /etc/apt/sources.list /etc/apt/sources.list.d || echo "$source" > "$backports_list"
    apt-get update -q
    $backports
fi
if ! new_enough "$(installed)"; then
    echo "No Mesa Vulkan driver $needed or newer for '$codename' (found '$(installed)'): SAPIEN cannot render." >&2
    echo "Install an NVIDIA driver, or use Debian 12 with backports, Debian 13 or Ubuntu 24.04.3 or newer." >&2
    exit 1
fi
