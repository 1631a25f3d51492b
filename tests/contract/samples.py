"""One message of every kind, every field filled in. `python -m tests.contract.samples` adds golden files."""

import sys
from pathlib import Path

import numpy as np

from shared.messages import (
    body,
    camera,
    drive,
    estop,
    inspections,
    maps,
    matching,
    places,
    sensors,
    simulation,
    tasks,
    traffic,
)
from shared.messages import features as looks
from shared.messages import missions as orders
from shared.messages.base import Message
from shared.messages.matching import DIFFERENCES_SHAPE
from shared.wire import encode

GOLDEN = Path(__file__).parent / "golden"
STAMP_NS = 1_700_000_000_000_000_000
HALF = (True, False) * 6


def features() -> looks.Features:
    return looks.Features(
        sizes_rad=np.array([0.01, 0.02], np.float32),
        seq=7,
        stamp_ns=STAMP_NS,
        robot="r1",
        lockstep=True,
        pipeline="sift/tangent/150",
        lonlat_rad=np.array([[0.5, -0.25], [-3.0, 0.125]], np.float32),
        scores=np.array([2.0, 1.0], np.float32),
        descriptors=np.arange(16, dtype=np.float32).reshape(2, 8),
        thumbnail=b"\xff\xd8\xff\xd9",
        photo=looks.PhotoView(fov_rad=1.25, fov_known=True, aspect=0.75),
        extract_ms=42.5,
    )


def photo() -> looks.Photo:
    view = looks.PhotoView(fov_rad=1.25, fov_known=True, aspect=0.5)
    return looks.Photo(view=view, width_px=64, height_px=128, data=bytes(range(256)) * 96)


def frame() -> sensors.Frame:
    return sensors.Frame(
        seq=7,
        stamp_ns=STAMP_NS,
        robot="r1",
        lockstep=True,
        encoding="bgr8",
        width_px=4,
        height_px=2,
        data=bytes(range(24)),
        gravity=(0.6, 0.0, -0.8),
    )


def node(node_id: int) -> maps.Node:
    return maps.Node(
        node_id=node_id,
        stamp_ns=STAMP_NS,
        frame_seq=7,
        pipeline="sift",
        keypoints=2,
        open=HALF,
        explored=HALF,
    )


def edge() -> maps.Edge:
    return maps.Edge(
        a=1,
        b=2,
        raw_matches=60,
        inliers=40,
        confidence=0.75,
        heading_ab_rad=0.5,
        heading_ba_rad=-2.5,
        yaw_ab_rad=0.125,
        disparity_rad=0.25,
        s_min=30,
        s_max=60,
        pipeline="sift",
        clear=True,
        length_m=1.4,
        length_std_m=0.2,
        traversals=2,
        failures=1,
        suspended=True,
        why="seen from one another",
    )


def marks() -> places.Marks:
    edge = ((1, 2),)
    night = places.Hours(days=("mon", "sun"), opens="22:00", closes="06:00")
    return places.Marks(
        places=(places.Place(name="Küche 2", nodes=(2, 1)),),
        rules=(
            places.KeepOut(name="no robots", nodes=(1,), areas=("Küche 2",)),
            places.OneWay(name="lane", edges=edge),
            places.Slow(name="ramp", edges=edge, speed_share=0.25),
            places.OpeningHours(name="door", edges=edge, hours=(night,), time_zone="Europe/Berlin"),
        ),
        routes=(places.Route(name="round", nodes=(1, 2, 1)),),
        signs=(
            places.Sign(
                name="214",
                sightings=(places.Sighting(node=1, bearing_rad=-0.5, height_rad=0.125, confidence=0.75),),
            ),
        ),
    )


def operations() -> tuple[maps.Operation, ...]:
    return (
        maps.AddNode(node=node(1), features=features()),
        maps.UpdateNode(node=node(1)),
        maps.PutEdge(edge=edge()),
        maps.DeleteEdge(a=1, b=2),
        maps.DeleteNode(node_id=2),
        *(places.PutPlace(place=place) for place in marks().places),
        *(places.PutRule(rule=rule) for rule in marks().rules),
        places.DeletePlace(name="dock"),
        places.DeleteRule(name="lane"),
        *(places.PutRoute(route=route) for route in marks().routes),
        places.DeleteRoute(name="round"),
        *(places.PutSign(sign=sign) for sign in marks().signs),
        places.DeleteSign(name="214"),
    )


def mission() -> maps.MissionRecord:
    return maps.MissionRecord(
        seq=7,
        stamp_ns=STAMP_NS,
        robot="r1",
        epoch=3,
        mission_id="m-1",
        action="goto",
        map="flat",
        parameters={"rounds": 2, "places": ["dock", "door"]},
        checkpoint={"visit": 3},
        goal=features(),
        goal_node=4,
        seed=1,
        max_steps=500,
        step=12,
        paused=True,
        paused_by="emergency_stop",
        ended_action="explore",
        outcome="failed",
        failure="lost",
        reason="the map is gone",
    )


def truth() -> simulation.Truth:
    return simulation.Truth(
        seq=7,
        stamp_ns=STAMP_NS,
        robot="r1",
        world="apartment",
        pose=simulation.Pose(x_m=1.0, y_m=-2.0, yaw_rad=0.5),
        hider=simulation.Pose(x_m=3.0, y_m=4.0, yaw_rad=-0.5),
        sim_time_s=12.5,
        speed_mps=0.25,
        collisions=1,
        render_ms=60.5,
    )


def node_match() -> matching.NodeMatch:
    return matching.NodeMatch(
        node_id=1,
        raw_matches=2,
        inliers=1,
        status="ok",
        heading_rad=0.5,
        heading_std_rad=0.0625,
        yaw_rad=-0.5,
        disparity_rad=0.25,
        confidence=0.75,
        noise_rad=0.005,
        moved=1,
        differences=np.full(DIFFERENCES_SHAPE, 9.5, np.float32),
        matches_rad=np.array([[0.5, 0.25, 0.75, 0.125], [1.0, 0.0, 2.0, 0.0]], np.float32),
        inlier_mask=np.array([1, 0], np.uint8),
        right=np.array([0.75, 0.5], np.float32),
        log_scale=np.array([0.125, -0.5], np.float32),
    )


AT = {"seq": 7, "stamp_ns": STAMP_NS}
MOTION = {"forward_mps": 0.5, "left_mps": -0.25, "turn_radps": 0.75}
DRIVE = AT | {"robot": "r1", "epoch": 3, "ttl_ms": 300, "why": "ahead"}


def seen() -> tuple[Message, ...]:
    """What robots sense and the feature service makes of it."""
    return (
        frame(),
        camera.CameraState(
            **AT,
            robot="r1",
            source="osc://192.168.1.1",
            problem="no connection: timed out",
            model="RICOH THETA Z1",
            mode="image",
            battery_fraction=0.5,
            rate_hz=8.0,
            delay_s=0.4,
            width_px=1024,
            height_px=512,
        ),
        sensors.Ranges(
            **AT,
            robot="r1",
            lockstep=True,
            angles_rad=(0.5,) * 12,
            distances_m=(2.5,) * 12,
            max_range_m=5.0,
            step_s=0.3,
        ),
        body.Odometry(**AT, **MOTION, robot="r1", x_m=1.5, y_m=-2.5, yaw_rad=0.5),
        body.Imu(
            **AT,
            robot="r1",
            gravity=(0.6, 0.0, -0.8),
            turn_radps=(0.0, 0.25, 0.5),
            acceleration_mps2=(0.5, 0.0, -0.25),
        ),
        body.Battery(**AT, robot="r1", share=0.75, charging=True, voltage_v=12.5),
        features(),
        looks.ExtractRequest(**AT, frame=frame()),
        looks.ExtractPhotoRequest(**AT, photo=photo()),
        matching.MatchRequest(
            **AT,
            map="flat",
            map_revision=5,
            features=features(),
            node_ids=(1, 2),
            best_k=3,
            targets=(features(),),
            with_matches=False,
            with_differences=True,
        ),
        matching.MatchReply(
            **AT,
            map="flat",
            map_revision=5,
            pipeline="sift",
            max_similarity=150,
            results=(node_match(),),
            match_ms=1.5,
            verify_ms=2.5,
        ),
    )


def driven() -> tuple[Message, ...]:
    """Headings, commands and the emergency stop."""
    return (
        drive.Heading(
            **DRIVE,
            mission_id="m-1",
            action="hold",
            heading_rad=0.5,
            face_rad=-1.5,
            s_cv=70,
            s_slow=90,
            s_max=150,
            speed_fraction=0.5,
            distance_m=2.5,
            method="epipolar",
        ),
        drive.Velocity(**DRIVE, **MOTION, at_ns=STAMP_NS, avoiding=True),
        drive.Manual(**AT, **MOTION, robot="r1", who="anna", action="release", ttl_ms=300),
        estop.EStopRequest(**AT, action="clear", who="anna", why="the floor is free"),
        estop.EStopState(**AT, robot="r1", engaged=True, who="anna", why="a child", since_ns=STAMP_NS),
    )


def missions() -> tuple[Message, ...]:
    """Missions and what is told of them."""
    return (
        orders.MissionRequest(
            **AT,
            action="goto",
            map="flat",
            mission_id="m-1",
            parameters={"rounds": 2, "places": ["dock", "door"]},
            checkpoint={"visit": 3},
            goal=features(),
            goal_node=4,
            seed=1,
            max_steps=9,
        ),
        orders.MissionStatus(
            **AT,
            robot="r1",
            mission_id="m-1",
            action="goto",
            map="flat",
            state="failed",
            failure="lost",
            reason="no node looks like this",
            step=12,
            nodes=5,
            edges=6,
            open_directions=7,
            via_points=(1, 2),
            via_index=1,
            nearest_node=2,
            similarity=70,
            disparity_rad=0.25,
            epoch=3,
            figures=(orders.EventValue(name="similarity", value=70),),
            paused_by="emergency_stop",
            travel="following",
            travel_reason="a path leads from a node in sight to the destination",
        ),
    )


def kinds() -> tuple[Message, ...]:
    """Kinds of mission, and decisions."""
    return (
        orders.MissionKindsRequest(**AT),
        orders.MissionKinds(
            **AT,
            kinds=(
                orders.MissionKindInfo(
                    name="patrol",
                    title="Go round",
                    parameters={"type": "object", "properties": {"rounds": {"type": "integer"}}},
                    shown=("rounds",),
                    takes_picture=True,
                    by_hand=True,
                ),
            ),
        ),
        orders.Event(
            **AT,
            robot="r1",
            mission_id="m-1",
            step=12,
            kind="edge",
            reason="similar",
            values=(orders.EventValue(name="s", value=70), orders.EventValue(name="heading", value=0.5)),
        ),
    )


def mapped() -> tuple[Message, ...]:
    """Maps, and the missions that the map store keeps."""
    return (
        maps.MapRequest(
            **AT,
            action="transact",
            author="planner",
            base_revision=4,
            request_id="c0ffee",
            operations=operations(),
            node_ids=(1, 2),
        ),
        maps.MapReply(
            **AT,
            map="flat",
            revision=5,
            nodes=(node(1), node(2)),
            edges=(edge(),),
            places=marks().places,
            rules=marks().rules,
            routes=marks().routes,
            signs=marks().signs,
            features=(maps.NodeFeatures(node_id=1, features=features()),),
            pictures=(maps.NodePicture(node_id=1, picture=b"\xff\xd8 a picture"),),
        ),
        maps.MapDelta(
            **AT,
            map="flat",
            revision=5,
            reset=True,
            renamed_to="house",
            author="planner",
            operations=operations(),
        ),
        mission(),
        maps.MissionRecordRequest(**AT, action="save", record=mission()),
    )


def errand() -> dict[str, object]:
    return {
        "kind": "patrol",
        "map": "flat",
        "parameters": {"places": ["dock", "door"]},
        "priority": 7,
        "seed": 3,
        "max_steps": 99,
    }


def task() -> tasks.Task:
    return tasks.Task(
        **errand(),
        task_id="night-1700000000",
        robot="r1",
        state="failed",
        failure="refused",
        reason="no place 'dock'",
        attempt=2,
        checkpoint={"visit": 1},
        put_back=True,
        for_battery=True,
        schedule="night",
        by="anna",
        fleet=True,
        due_ns=STAMP_NS,
        created_ns=STAMP_NS + 1,
        started_ns=STAMP_NS + 2,
        ended_ns=STAMP_NS + 3,
    )


def schedule() -> tasks.Schedule:
    return tasks.Schedule(
        name="night",
        robot="r1",
        cron="30 22 * * MON-FRI",
        time_zone="Europe/Zurich",
        task=tasks.Errand(**errand()),
        enabled=False,
        handled_ns=STAMP_NS,
        skipped_ns=STAMP_NS + 1,
        skipped=2,
    )


def queued() -> tuple[Message, ...]:
    """Tasks, schedules, and what is told of the queue."""
    return (
        tasks.TaskRequest(
            **AT,
            action="make_due",
            task_id="night-1700000000",
            task=task(),
            priority=7,
            reason="the robot was off",
            schedule=schedule(),
            name="night",
            due_ns=STAMP_NS,
            skip=True,
            to="r2",
            ended=20,
        ),
        tasks.TaskReply(
            **AT,
            robot="r1",
            tasks=(task(),),
            ended=(task(),),
            latest=task(),
            task=task(),
            schedules=(schedule(),),
            damaged=1,
        ),
        tasks.QueueStatus(
            **AT,
            robot="r1",
            waiting=2,
            running="night-1700000000",
            why="anna drives by hand",
            on_hold=True,
            alarm="did not get home",
        ),
    )


def inspection() -> inspections.Inspection:
    return inspections.Inspection(
        seq=7,
        stamp_ns=STAMP_NS,
        robot="r1",
        mission_id="m-1",
        round=2,
        place="Küche 2",
        against_ns=STAMP_NS - 5_000_000_000,
        why="told",
        inliers=120,
        yaw_rad=-0.5,
        disparity_rad=0.03125,
        regions=(region(),),
        picture=b"\xff\xd8\xff\xd9",
    )


def region() -> inspections.Region:
    return inspections.Region(
        bearing_rad=0.5, elevation_rad=-0.25, width_rad=0.25, height_rad=0.5, score=0.125
    )


def inspected() -> tuple[Message, ...]:
    """Pictures of places compared and kept."""
    about = {"seq": 7, "stamp_ns": STAMP_NS}
    return (
        inspections.CompareRequest(**about, reference=b"\xff\xd8\xff\xd9"),
        inspections.CompareReply(
            **about,
            picture=b"\xff\xd8\xff\xd9",
            compared=True,
            why="told",
            inliers=120,
            yaw_rad=-0.5,
            disparity_rad=0.03125,
            regions=(region(),),
            took_ms=400.5,
        ),
        inspections.InspectionRequest(
            **about,
            action="save",
            place="Küche 2",
            mission_id="m-1",
            round=2,
            inspection=inspection(),
            keep=5,
        ),
        inspections.InspectionReply(**about, inspection=inspection()),
    )


def rights_of_way() -> tuple[Message, ...]:
    """Among robots of one map."""
    at = {"seq": 7, "stamp_ns": STAMP_NS}
    return (
        traffic.WayRequest(**at, robot="r1", map="flat", at=(4, 5), ahead=(6, 7, 8), busy=True),
        traffic.WayReply(**at, free=2, why="the way beyond is taken by r2", room=(5, 9)),
    )


def simulated() -> tuple[Message, ...]:
    """Simulation only."""
    return (
        truth(),
        simulation.SimulationRequest(
            **AT,
            action="place_obstacle",
            pose=simulation.Pose(x_m=1.0, y_m=2.0, yaw_rad=0.5),
            seed=3,
            item="box-1",
            kind="basket",
            present=True,
            illumination=0.5,
        ),
        simulation.SimulationReply(**AT, truth=truth(), frame=frame()),
    )


def samples() -> dict[type[Message], Message]:
    """Message type -> a full example."""
    examples = (*seen(), *driven(), *missions(), *kinds(), *mapped(), *queued(), *inspected())
    examples = (*examples, *rights_of_way(), *simulated())
    return {type(example): example for example in examples}


def golden_files(kind: type[Message]) -> list[Path]:
    """Bytes of one kind that were sent at some time, newest last: NAME.msgpack, NAME-2.msgpack, ..."""
    return sorted(GOLDEN.glob(f"{kind.SCHEMA}[-.]*msgpack"), key=lambda path: (len(path.name), path.name))


def main() -> int:
    """Add a golden file for each message that got a field; old ones stay: old programs still send them."""
    GOLDEN.mkdir(exist_ok=True)
    for kind, example in samples().items():
        known = golden_files(kind)
        if not known or known[-1].read_bytes() != encode(example):
            number = f"-{len(known) + 1}" if known else ""
            (GOLDEN / f"{kind.SCHEMA}{number}.msgpack").write_bytes(encode(example))
    return 0


if __name__ == "__main__":
    sys.exit(main())
