"""The growth of maps and of fleets is drawn in one picture."""

from PIL import Image

from experiments.scale.drawing import draw_growth

POINTS = [
    {"nodes": n, "exhaustive_ms": e, "localise_p99_ms": 40.0, "localise_p50_ms": 12.0, "track_p50_ms": 8.0}
    | {"load_s": n / 1000, "bytes_per_node": 22_600}
    for n, e in ((100, 200.0), (1000, None))
]
ROBOTS = [
    {"robots": n, "services": k, "rate_hz": rate, "frames_per_s": 2.0 * n, "p50_ms": 90.0, "p99_ms": 150.0}
    for rate in (0.0, 2.0)
    for k in (1, 2)
    for n in (1, 2, 4)
    if n >= k
]


def test_a_size_that_was_not_compared_exhaustively_and_any_number_of_services_are_drawn(tmp_path):
    draw_growth(tmp_path / "scale.png", POINTS, ROBOTS)
    picture = Image.open(tmp_path / "scale.png")
    assert picture.width > 800
    assert len(picture.convert("RGB").getcolors(1_000_000)) > 20
