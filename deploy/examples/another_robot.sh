#!/usr/bin/env bash
# One more simulated robot beside a running stack, in the same maps: its own simulator, planner, drive and
# dispatch; feature service, map store and page are shared. Each simulator shows the robots of its company.
#
#   TOPNAV_FEATURES_ROBOTS=r1,r2 SIMULATOR_COMPANY=r2 topnav up --detach
#   SIMULATOR_COMPANY=r1 deploy/examples/another_robot.sh r2
#
# PYTHON, TOPNAV_ENDPOINT, TOPNAV_DATA_DIR and the settings of the four services may be set before.
set -euo pipefail

export TOPNAV_ROBOT=${1:?name of the robot, for example r2}
export TOPNAV_ENDPOINT=${TOPNAV_ENDPOINT:-tcp/127.0.0.1:7447}
export SIMULATOR_WORLD=${SIMULATOR_WORLD:-${TOPNAV_WORLD:-apartment}}
export SIMULATOR_CACHE_DIR=${SIMULATOR_CACHE_DIR:-$HOME/.cache/topnav}
export SIMULATOR_WIDTH_PX=${SIMULATOR_WIDTH_PX:-1024}
state=${TOPNAV_DATA_DIR:-data}/$TOPNAV_ROBOT
export SIMULATOR_STATE_DIR=$state/robot-state DRIVE_STATE_DIR=$state/drive-state

services=()
trap 'kill "${services[@]}" 2>/dev/null; wait' EXIT
trap 'exit 0' INT TERM
for module in simulator services.planner services.drive services.dispatch; do
    "${PYTHON:-python}" -m "$module" &
    services+=($!)
done
wait -n # whichever ends first takes the others along
