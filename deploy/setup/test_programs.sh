#!/usr/bin/env bash
# The programs that some tests need: a Chromium for the console's, a PostgreSQL server for the map store's, and ip for
# the line between two hosts.
#
# As root on Debian or Ubuntu they are installed here; otherwise the command is printed. Without them those tests are
# skipped with the reason, so a missing program stops nothing.
set -euo pipefail
servers="${TOPNAV_POSTGRES_FOLDER:-/usr/lib/postgresql}"
missing=()

for browser in chromium chromium-browser google-chrome; do
    command -v "$browser" >/dev/null && break
done || missing+=(chromium)
[ -n "$(ls "$servers"/*/bin/initdb 2>/dev/null)" ] || missing+=(postgresql)
command -v ip >/dev/null || [ -x /usr/sbin/ip ] || missing+=(iproute2)
[ "${#missing[@]}" -eq 0 ] && exit 0

install="apt-get install -y --no-install-recommends ${missing[*]}"
if ! command -v apt-get >/dev/null || [ "$(id -u)" -ne 0 ]; then
    echo "Tests that need ${missing[*]} are skipped. To run them: sudo $install" >&2
    exit 0
fi
export DEBIAN_FRONTEND=noninteractive
if ! { apt-get update -q && $install; }; then
    echo "Could not install ${missing[*]}: the tests that need them are skipped." >&2
fi
