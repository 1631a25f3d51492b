#!/usr/bin/env bash
# Send a robot to where a picture was taken, with nothing but HTTP.
#   deploy/examples/goto.sh MAP PICTURE.png        (TOPNAV_URL, TOPNAV_ROBOT and TOPNAV_TOKEN may be set)
set -euo pipefail
map=$1 picture=$2
api=${TOPNAV_URL:-http://127.0.0.1:8000}/api/robots/${TOPNAV_ROBOT:-r1}
ask=(curl --silent --show-error --fail-with-body --header "Authorization: Bearer ${TOPNAV_TOKEN:-}")

# 1. Does the robot know this place? The answer says found, weak or not_found, and names the best nodes.
"${ask[@]}" --header 'Content-Type: image/png' --data-binary "@$picture" "$api/goal-check?map=$map"
echo

# 2. Go there.
"${ask[@]}" --header 'Content-Type: image/png' --data-binary "@$picture" "$api/missions/goto?map=$map"
echo

# 3. Wait for the end; each question is answered after at most 30 s.
answer=""
until [[ $answer == *'"done":true'* ]]; do
    answer=$("${ask[@]}" --retry 8 --retry-connrefused "$api/mission/wait?timeout_s=30")
    echo "$answer" | cut -c 1-200
done
echo "$answer"
[[ $answer == *'"state":"succeeded"'* ]]
