#!/usr/bin/env bash
# What a newcomer does with Docker Compose, for real: `make containers`.
#
# Builds the images, starts the stack without any file, explores and drives to a picture over HTTP, ends every
# container once, and starts it with .env.example and with the secured bus. DOCKER and CURL may be others, as those
# of an engine in a namespace of its own. Exits with 0 and the reason where there is no engine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
read -ra docker <<<"${DOCKER:-docker}"
read -ra curl <<<"${CURL:-curl}"
folder=$(mktemp -d)
export COMPOSE_PROJECT_NAME=topnav-containers TOPNAV_SEED=1
services=(router map-store simulator features planner drive gateway)

if ! "${docker[@]}" compose version >/dev/null 2>&1 || ! "${docker[@]}" info >/dev/null 2>&1; then
    echo "make containers: skipped, no Docker Engine with Compose answers" >&2
    exit 0
fi

compose() { "${docker[@]}" compose --env-file "${file:-/dev/null}" "$@"; }
say() { printf '%s (%d s)\n' "$*" "$((SECONDS - began))"; began=$SECONDS; }
finish() {
    status=$?
    [ "$status" -eq 0 ] || compose --profile secure logs --tail 20
    compose --profile secure down --volumes --timeout 5 >/dev/null 2>&1 || :
    rm -rf "$folder"
    exit "$status"
}
trap finish EXIT
began=$SECONDS

ask() { "${curl[@]}" --silent --show-error --fail-with-body --max-time 100 --header "Authorization: Bearer $token" "$@"; }
up() { compose "$@" up --detach --wait --wait-timeout 180 >"$folder/up.log" 2>&1 || { cat "$folder/up.log"; return 1; }; }
read_token() { token=$(compose exec -T gateway cat /var/lib/topnav/token/token); }
api=http://127.0.0.1:8000/api
robot=$api/robots/r1

compose --profile secure build --quiet
say "built"
"${docker[@]}" images --format '{{.Repository}} {{.Size}}' 'topnav/*' | sort

up
read_token
"${curl[@]}" --silent --fail http://127.0.0.1:8000/readyz >/dev/null
say "ready without any file"
test "$("${curl[@]}" --silent --output /dev/null --write-out '%{http_code}' "$api/robots")" = 401

ask --json '{"action": "explore", "map": "flat", "seed": 1}' "$robot/missions" >/dev/null
sleep "${EXPLORE_S:-60}"
ask "$robot/frame.jpg?width=1024" >"$folder/goal.jpg"
sleep "$((${EXPLORE_S:-60} / 3))"
ask --request POST "$robot/missions/cancel" >/dev/null
say "explored: $(ask "$api/maps/flat" | cut -c 1-120)"
ask --header 'Content-Type: image/jpeg' --data-binary @- "$robot/missions/goto?map=flat" <"$folder/goal.jpg" >/dev/null
answer=""
until [[ $answer == *'"done":true'* ]]; do
    answer=$(ask "$robot/mission/wait?timeout_s=60")
    [ "$((SECONDS - began))" -lt 300 ] || break
done
grep --quiet '"state":"succeeded"' <<<"$answer" || { echo "not arrived: $answer"; exit 1; }
say "at the picture"

for one in "${services[@]}"; do
    compose kill "$one" >/dev/null 2>&1
    up
done
ask "$api/maps/flat" >/dev/null
say "every container was killed once and is back"
compose down --volumes --timeout 5 >/dev/null 2>&1

file=.env.example
up
read_token
ask "$api/robots" >/dev/null
say "ready with .env.example"
compose down --volumes --timeout 5 >/dev/null 2>&1

file=/dev/null
export TOPNAV_BUS=tls
up --profile secure
read_token
ask --json '{"action": "explore", "map": "flat"}' "$robot/missions" >/dev/null
until ask "$api/maps/flat" | grep --quiet '"nodes":[1-9]'; do
    [ "$((SECONDS - began))" -lt 120 ] || exit 1
    sleep 1
done
say "a mission on the secured bus"
