#!/usr/bin/env bash
# Make the virtual environment: venv.sh PYTHON FOLDER
set -euo pipefail
python="$1"
folder="$2"

if ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
    echo "topnav needs Python 3.11 or newer, '$python' is $("$python" --version 2>&1)." >&2
    echo "Name another one: make setup PYTHON=/path/to/python3.11" >&2
    exit 1
fi

# Debian and Ubuntu split `venv` off Python: without this package ensurepip is missing.
if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
    package="python$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')-venv"
    if [ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null; then
        apt-get update -q
        DEBIAN_FRONTEND=noninteractive apt-get install -y -q "$package"
    else
        echo "Python's venv module is missing. Run this, then 'make setup' again:" >&2
        echo "  sudo apt-get install $package" >&2
        exit 1
    fi
fi

[ -x "$folder/bin/python" ] || "$python" -m venv "$folder"
