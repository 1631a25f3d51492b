"""A drive controller that needs nothing of this project: the schemas in deploy/contracts, zenoh and msgpack.

Run it instead of the drive service: python swap_drive.py tcp/127.0.0.1:7447 r1
It answers each ranges.v1 with one command.v1; in lockstep once the heading.v1 of the same frame is there.
"""

import math
import sys
import time
import uuid

import msgpack
import zenoh

BODY_M, AHEAD_M, RADPS, TTL_MS = 0.31, 0.5, 4.0, 300


def free(heading_rad, ranges):
    """Whether a robot of BODY_M radius can go AHEAD_M that way without touching what the sensors saw."""
    for angle, reach in zip(ranges["angles_rad"], ranges["distances_m"], strict=True):
        forward, aside = reach * math.cos(angle - heading_rad), reach * math.sin(angle - heading_rad)
        if 0.0 < forward < AHEAD_M and abs(aside) < BODY_M and reach < ranges["max_range_m"]:
            return False
    return True


def command(heading, ranges, side):
    """Command along the free direction nearest to the wished one, and the side it passes on (+1 is left)."""
    turns = [0.0] + [side * sign * math.radians(d) for sign in (1, -1) for d in range(10, 180, 10)]
    turn = next((t for t in turns if free(heading["heading_rad"] + t, ranges)), None)
    go = heading["action"] == "go" and turn is not None
    steer_rad = math.remainder(heading["heading_rad"] + (turn or 0.0), math.tau)
    message = {key: heading[key] for key in ("seq", "stamp_ns", "robot", "epoch")}
    speed = RADPS * heading["speed_fraction"] if go else 0.0
    message |= {"schema": "command.v1", "steer_rad": steer_rad, "wheel_speed_radps": speed, "ttl_ms": TTL_MS}
    return message, side if not turn else int(math.copysign(1, turn))


def main(endpoint, robot):
    """Serve until interrupted."""
    config = zenoh.Config.from_json5(
        f'{{mode: "peer", connect: {{endpoints: ["{endpoint}"]}}, listen: {{endpoints: ["tcp/127.0.0.1:0"]}},'
        " scouting: {multicast: {enabled: false}}}"
    )
    with zenoh.open(config) as bus:
        ring = zenoh.handlers.RingChannel
        inputs = {n: bus.declare_subscriber(f"topnav/{robot}/{n}", ring(1)) for n in ("heading", "ranges")}
        output, newest, side = bus.declare_publisher(f"topnav/{robot}/command"), {}, 1
        alive = bus.liveliness().declare_token(f"topnav/alive/drive/{uuid.uuid4().hex}")
        while alive:
            time.sleep(0.004)
            for name, subscriber in inputs.items():
                if (sample := subscriber.try_recv()) is not None:
                    newest[name] = (msgpack.unpackb(sample.payload.to_bytes()), time.monotonic())
            if len(newest) < 2:
                continue
            (heading, since_s), (ranges, _) = newest["heading"], newest["ranges"]
            fresh = time.monotonic() - since_s < heading["ttl_ms"] / 1000
            paired = all(heading[key] == ranges[key] for key in ("seq", "stamp_ns"))
            if paired if ranges["lockstep"] else fresh:
                message, side = command(heading, ranges, side)
                output.put(msgpack.packb(message))
                del newest["ranges"]


if __name__ == "__main__":
    main(*sys.argv[1:3])
