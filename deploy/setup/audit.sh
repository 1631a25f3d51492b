#!/usr/bin/env bash
# What is installed, and what is known against it: audit.sh sbom|audit VENV
#   sbom   writes build/sbom.cdx.json, a CycloneDX bill of materials of VENV
#   audit  asks PyPI for known vulnerabilities of every version in constraints.txt; 1 when there is one, or when a
#          package could not be looked up (TOPNAV_AUDIT_SERVICE=osv asks osv.dev instead)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
what="${1:-}"
venv="${2:-.venv}"
tools=build/audit-tools
if [ "$what" != sbom ] && [ "$what" != audit ]; then
    echo "audit.sh needs 'sbom' or 'audit', got '$what'" >&2
    exit 2
fi

if ! cmp -s deploy/setup/audit-requirements.txt "$tools/installed.txt"; then
    rm -rf "$tools"
    "$venv/bin/python" -m venv "$tools"
    "$tools/bin/python" -m pip install --quiet --requirement deploy/setup/audit-requirements.txt
    cp deploy/setup/audit-requirements.txt "$tools/installed.txt"
fi

if [ "$what" = sbom ]; then
    "$tools/bin/cyclonedx-py" environment --pyproject pyproject.toml --mc-type application --output-reproducible \
        --output-file build/sbom.cdx.json "$venv/bin/python"
    echo "build/sbom.cdx.json: $(grep -c '"bom-ref"' build/sbom.cdx.json) components"
    exit
fi

# The shim is ours (deploy/packaging/opencv-shim): nobody could report it.
grep -v '^opencv-python==' constraints.txt > build/audited.txt
# --strict: an audit that could not look anything up must not pass.
"$tools/bin/pip-audit" --requirement build/audited.txt --no-deps --disable-pip --strict --progress-spinner off \
    --vulnerability-service "${TOPNAV_AUDIT_SERVICE:-pypi}"
