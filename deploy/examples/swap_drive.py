"""A drive controller that needs nothing of this project: the schemas in deploy/contracts, zenoh and msgpack.

Run it instead of the drive service: python swap_drive.py tcp/127.0.0.1:7447 r1
It answers each ranges.v1 with one velocity.v1; in lockstep once the heading.v1 of the same frame is there.
"""

import math
import queue
import sys
import time

import msgpack
import zenoh


def blocked(ranges, way_rad):
    """Whether something that the sensors saw stands in the next 0.5 m of a lane 0.62 m wide."""
    readings = zip(ranges["angles_rad"], ranges["distances_m"], strict=True)
    seen = [(m, angle - way_rad) for angle, m in readings if m < ranges["max_range_m"]]
    return any(0.0 < m * math.cos(turn) < 0.5 and abs(m * math.sin(turn)) < 0.31 for m, turn in seen)


def velocity(heading, ranges, side):
    """Drive the wished way, else a free one beside it, first on the side (+1 is left) of the last detour."""
    detours = [0, *(math.radians(s * degrees) for s in (side, -side) for degrees in range(10, 180, 10))]
    detour = next((d for d in detours if not blocked(ranges, heading["heading_rad"] + d)), None)
    speed = 0.32 * heading["speed_fraction"] if heading["action"] == "go" and detour is not None else 0.0
    answer = {key: heading[key] for key in ("seq", "stamp_ns", "robot", "epoch")}
    way_rad = heading["heading_rad"] + (detour or 0)
    answer |= {"schema": "velocity.v1", "ttl_ms": 250, "at_ns": ranges["stamp_ns"]}
    answer |= {"forward_mps": speed * math.cos(way_rad), "left_mps": speed * math.sin(way_rad)}
    return answer, math.copysign(1, detour) if detour else side


def main(endpoint, robot):
    """Serve until interrupted."""
    arrived, newest, side = queue.SimpleQueue(), {}, 1
    config = zenoh.Config.from_json5(f'{{mode: "client", connect: {{endpoints: ["{endpoint}"]}}}}')
    with zenoh.open(config) as bus:
        for name in ("heading", "ranges"):
            bus.declare_subscriber(f"topnav/{robot}/{name}", arrived.put)
        velocities = bus.declare_publisher(f"topnav/{robot}/velocity")
        alive = bus.liveliness().declare_token(f"topnav/alive/drive/{bus.info.zid()}")
        while alive:
            message = msgpack.unpackb(arrived.get().payload.to_bytes())
            newest[message["schema"]] = message | {"came_s": time.monotonic()}
            if len(newest) == 2:
                heading, ranges = newest["heading.v1"], newest["ranges.v1"]
                paired = heading["stamp_ns"] == ranges["stamp_ns"]
                fresh = time.monotonic() - heading["came_s"] < heading["ttl_ms"] / 1000
                if paired if ranges["lockstep"] else fresh:
                    answer, side = velocity(heading, ranges, side)
                    velocities.put(msgpack.packb(answer))
                    del newest["ranges.v1"]


if __name__ == "__main__":
    main(*sys.argv[1:3])
