#!/usr/bin/env bash
# What a newcomer does with Docker Compose, for real: `make containers`.
#
# Builds the images, starts the stack without any file, explores and drives to a picture over HTTP, once more with
# another drive controller, and ends every container once. Then it starts the stack with .env.example, a folder of
# worlds and a busy machine, on the secured bus, and with the robot on a host of its own. DOCKER and CURL may be
# others, as those of an engine in a namespace of its own. CI_FULL builds the image with torch as well. Exits with 0
# and the reason where there is no engine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
read -ra docker <<<"${DOCKER:-docker}"
read -ra curl <<<"${CURL:-curl}"
folder=$(mktemp -d)
export COMPOSE_PROJECT_NAME=topnav-containers TOPNAV_SEED=1
services=(router map-store simulator features planner drive dispatch gateway)

if ! "${docker[@]}" compose version >/dev/null 2>&1 || ! "${docker[@]}" info >/dev/null 2>&1; then
    echo "make containers: skipped, no Docker Engine with Compose answers" >&2
    exit 0
fi

compose() { "${docker[@]}" compose --env-file "${file:-/dev/null}" "$@"; }
robot_host() { "${docker[@]}" compose --env-file /dev/null --project-name topnav-robot --file deploy/compose.robot.yml "$@"; }
load() { # N busy loops beside the stack, in a session of their own, as those of another terminal are
    [ -z "${loops:-}" ] || kill -- "-$loops" 2>/dev/null || :
    loops=""
    [ "$1" -gt 0 ] || return 0
    setsid bash -c 'for ((i = 0; i < $0; i++)); do while :; do :; done & done; wait' "$1" &
    loops=$!
}
say() { printf '%s (%d s)\n' "$*" "$((SECONDS - began))"; began=$SECONDS; }
finish() {
    status=$?
    load 0
    if [ "$status" -ne 0 ]; then
        compose --profile secure logs --tail 20
        cat "$folder/failed" 2>/dev/null || :
        echo "make containers: failed with $status after $((SECONDS - began)) s of this stage" >&2
    fi
    robot_host down --volumes --timeout 5 >/dev/null 2>&1 || :
    compose --profile secure down --volumes --timeout 5 >/dev/null 2>&1 || :
    rm -rf "$folder"
    exit "$status"
}
trap finish EXIT
began=$SECONDS

ask() { "${curl[@]}" --silent --show-error --fail-with-body --max-time 100 --header "Authorization: Bearer $token" "$@"; }
failed_up() { "$@" ps --all --format '{{.Service}} {{.Status}}' | cat "$folder/up.log" - >"$folder/failed"; } # said last
up_by() { # COMMAND: what runs Compose
    "$@" up --detach --wait --wait-timeout 900 >"$folder/up.log" 2>&1 || { failed_up "$@"; return 1; }
}
up() { up_by compose "$@"; }
read_token() { token=$(compose exec -T gateway cat /var/lib/topnav/token/token); }
api=http://127.0.0.1:8000/api
robot=$api/robots/r1
goto() {
    ask --header 'Content-Type: image/jpeg' --data-binary @- "$robot/missions/goto?map=flat" <"$1" >/dev/null
    answer="" until=$((SECONDS + 300))
    while [[ $answer != *'"done":true'* ]] && [ "$SECONDS" -lt "$until" ]; do
        answer=$(ask "$robot/mission/wait?timeout_s=60")
    done
    grep --quiet '"state":"succeeded"' <<<"$answer" || { echo "not arrived: $answer"; return 1; }
}
explores() { # a mission that maps
    ask --json '{"action": "explore", "map": "flat", "seed": 1}' "$robot/missions" >/dev/null
}
has_nodes() { # NUMBER: waits until the map has so many
    until [[ $(ask "$api/maps/flat") =~ '"nodes":'([0-9]+) && ${BASH_REMATCH[1]} -ge $1 ]]; do
        [ "$((SECONDS - began))" -lt 600 ] || { echo "the map has not $1 nodes"; return 1; }
        sleep 1
    done
}

compose --profile secure build --quiet
say "built"
if [ -n "${CI_FULL:-}" ]; then
    compose --file docker-compose.yml --file deploy/compose.learned.yml build --quiet features
    say "built features with torch"
fi
"${docker[@]}" images --format '{{.Repository}} {{.Size}}' 'topnav/*' | sort

up
read_token
"${curl[@]}" --silent --fail http://127.0.0.1:8000/readyz >/dev/null
say "ready without any file"
test "$("${curl[@]}" --silent --output /dev/null --write-out '%{http_code}' "$api/robots")" = 401

explores
has_nodes 4
ask "$robot/frame.jpg?width=1024" >"$folder/goal.jpg"
has_nodes 12
ask "$robot/frame.jpg?width=1024" >"$folder/other.jpg"
has_nodes 20 # what is around both pictures is mapped
ask --request POST "$robot/missions/cancel" >/dev/null
say "explored: $(ask "$api/maps/flat" | cut -c 1-120)"
goto "$folder/goal.jpg"
say "at the picture"

cat >"$folder/swap.yml" <<'END'
services:
  drive:
    image: topnav/drive-swapped:0.1.0
    build: !override
      context: deploy/examples
      dockerfile_inline: |
        FROM topnav/drive:0.1.0
        COPY swap_drive.py ./
    command: [python, swap_drive.py, "tcp/router:7447", r1]
END
compose --file docker-compose.yml --file "$folder/swap.yml" up --detach --wait --build drive >"$folder/up.log" 2>&1 ||
    { failed_up compose; exit 1; }
goto "$folder/other.jpg"
say "at another picture with another drive controller"

for one in "${services[@]}"; do
    compose kill "$one" >/dev/null 2>&1
    up
done
ask "$api/maps/flat" >/dev/null
say "every container was killed once and is back"
compose down --volumes --timeout 5 >/dev/null 2>&1

file=$folder/env
cat .env.example - >"$file" <<'END'
SIMULATOR_FRAME_RATE_HZ=3
TOPNAV_FILES_DIR=./deploy/examples/worlds
TOPNAV_WORLD=/var/lib/topnav/files/studio.yaml
END
load 16
up
load 0
read_token
ask "$api/robots" >/dev/null
test "$(compose exec -T simulator printenv SIMULATOR_FRAME_RATE_HZ)" = 3
test "$(compose exec -T simulator sh -c 'echo ${GATEWAY_TOKEN-none}')" = none
say "ready with .env.example and a world of one's own, beside 16 busy loops"
compose down --volumes --timeout 5 >/dev/null 2>&1

file=/dev/null
export TOPNAV_BUS=tls
up --profile secure
read_token
explores
has_nodes 1
say "a mission on the secured bus"
compose --profile secure down --volumes --timeout 5 >/dev/null 2>&1

export TOPNAV_ROUTER_HOST=172.17.0.1 # of this host as containers see it, on Docker's first bridge
services_host() { compose --progress quiet --file docker-compose.yml --file deploy/compose.services.yml --profile secure "$@"; }
up_by services_host
mkdir "$folder/certs"
services_host run --rm --no-deps --no-TTY certs tar -C /certs --numeric-owner -c simulator drive | tar -x -C "$folder/certs"
chmod 755 "$folder" # the containers' user looks in
export TOPNAV_ROBOT_CERTS=$folder/certs
up_by robot_host || { robot_host logs --tail 20; exit 1; }
read_token
explores
has_nodes 1
say "a mission with the robot on a host of its own"
