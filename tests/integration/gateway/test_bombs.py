"""Small files that unpack to gigabytes, against the gateway as a process: what a refusal costs it."""

import os
import socket
import statistics
import struct
import time
import zlib
from pathlib import Path

import httpx
import pytest
from PIL import Image

from tests.integration.gateway.corpus import bomb, chunk, saved
from tests.integration.gateway.gateway_process import Process, send

TIMES = 10
REFUSAL_CPU_S = 0.1
REFUSAL_MB = 50
LARGEST_MB = 500
"""More memory than before while the largest allowed picture is decoded; the container has 1 GB in all."""
LARGEST = {"PNG": (8192, 4096), "WEBP": (6324, 3162), "JPEG": (11_312, 5_656)}


def packed_chunk(name: bytes) -> bytes:
    """A good small PNG with a chunk of metadata that unpacks to 100 MB."""
    good = saved(Image.new("RGB", (256, 128)), "PNG")
    return good[:33] + chunk(name, b"k\0\0" + zlib.compress(bytes(100_000_000), 9)) + good[33:]


def jpeg(width: int, height: int) -> bytes:
    """A JPEG that claims this size."""
    good = bytearray(saved(Image.new("L", (256, 128)), "JPEG"))
    at = good.index(b"\xff\xc0")
    good[at + 5 : at + 9] = struct.pack(">HH", height, width)
    return bytes(good)


def webp(width: int, height: int) -> bytes:
    """A lossless WebP of one colour: thirty bytes, whatever its size."""
    good = bytearray(saved(Image.new("RGB", (256, 128)), "WEBP", lossless=True))
    bits = int.from_bytes(good[21:25], "little") & ~0x0FFFFFFF
    good[21:25] = (bits | width - 1 | (height - 1) << 14).to_bytes(4, "little")
    return bytes(good)


def scans(count: int) -> bytes:
    """A progressive JPEG with one of its scans over and over."""
    good = saved(Image.new("RGB", (256, 128)), "JPEG", progressive=True)
    at = good.rindex(b"\xff\xda")
    return good[:at] + good[at:-2] * count + good[-2:]


BOMBS = {
    "png 30000 x 30000": ("png", lambda: bomb(30_000, 30_000), 413, "too_many_pixels"),
    "png 30000 x 15000": ("png", lambda: bomb(30_000, 15_000), 413, "too_many_pixels"),
    "jpeg 65500 x 32750": ("jpeg", lambda: jpeg(65_500, 32_750), 413, "too_many_pixels"),
    "webp 16382 x 8191": ("webp", lambda: webp(16_382, 8_191), 413, "too_many_pixels"),
    "png with packed text": ("png", lambda: packed_chunk(b"zTXt"), 422, "damaged"),
    "png with a packed profile": ("png", lambda: packed_chunk(b"iCCP"), 422, "damaged"),
    "jpeg of 50000 scans": ("jpeg", lambda: scans(50_000), 422, "too_many_scans"),
    "gif 65535 x 65535": ("gif", lambda: b"GIF89a" + b"\xff" * 4 + bytes(20), 415, "unsupported_type"),
    "tiff as png": ("png", lambda: saved(Image.new("1", (4096, 2048)), "TIFF"), 415, "not_a_picture"),
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_costs_next_to_nothing(process: Process, name: str) -> None:
    kind, make, status, reason = BOMBS[name]
    body = make()
    walls_s, cpu_s, before, marked = [], cpu_seconds(process.pid), process.rss_bytes(), mark_peak(process.pid)
    with httpx.Client(base_url=process.address, trust_env=False, timeout=30.0) as client:
        headers = {"content-type": f"image/{kind}"}
        for _ in range(TIMES):
            began_s = time.monotonic()
            answer = client.post("/api/robots/r1/goal-check?map=flat", content=body, headers=headers)
            walls_s.append(time.monotonic() - began_s)
            assert answer.status_code == status, answer.text
            assert answer.json()["type"] == f"urn:topnav:problem:{reason}"
    cpu_s = (cpu_seconds(process.pid) - cpu_s) / TIMES
    grown_mb = peak_mb(process.pid) - before / 1e6
    print(  # noqa: T201  figures for the fault table: pytest -s
        f"{name}: {len(body)} bytes, wall p50 {1e3 * statistics.median(walls_s):.1f} ms, "
        f"max {1e3 * max(walls_s):.1f} ms, CPU {1e3 * cpu_s:.1f} ms, peak +{grown_mb:.1f} MB"
    )
    assert cpu_s < REFUSAL_CPU_S
    assert statistics.median(walls_s) < 20 * REFUSAL_CPU_S  # other tests may load the machine
    if marked:
        assert grown_mb < REFUSAL_MB
    assert process.rss_bytes() - before < REFUSAL_MB * 1e6


@pytest.mark.parametrize(
    ("kind", "mode", "options"),
    [
        ("PNG", "1", {}),
        ("PNG", "P", {"transparency": 0}),
        ("PNG", "RGBA", {"compress_level": 1}),
        ("PNG", "I;16", {"compress_level": 1}),
        ("WEBP", "RGB", {"lossless": True, "method": 0, "quality": 0}),
        ("JPEG", "RGB", {"progressive": True, "subsampling": 0}),
    ],
    ids=lambda value: str(value)[:12],
)
def test_the_largest_pictures_fit_into_the_containers_memory(
    process: Process, kind: str, mode: str, options: dict[str, object]
) -> None:
    body = saved(Image.new(mode, LARGEST[kind]), kind, **options)
    if not mark_peak(process.pid):
        pytest.skip("this kernel does not let the mark of highest memory be set back")
    before = process.rss_bytes()
    assert send(process, f"image/{kind.lower()}", body).status_code == 200
    grown_mb = peak_mb(process.pid) - before / 1e6
    print(f"{kind} {mode}: {len(body)} bytes, peak +{grown_mb:.0f} MB")  # noqa: T201
    assert grown_mb < LARGEST_MB


RAW_PATHS = [
    b"/api/maps/../../etc/passwd",
    b"/api/maps/%2e%2e/%2e%2e",
    b"/api/maps/..%2f..%2fetc%2fpasswd",
    b"/api/maps/..%5c..%5cx",
    b"/api/maps/a%00",
    b"/api/maps/a%0a",
    b"/api/maps/a%0d%0aX-Evil:%20yes",
    b"/api/maps/" + b"a" * 65,
    b"/api/maps/\xc3\xa4",
    b"/api/maps/%c3%a4",
    b"/api/maps/FLAT",
    b"/api/maps/*",
    b"/api/robots/r1%0a/status",
    b"/api/robots/../maps/frame.jpg",
    b"/api/robots/r1%00/frame.jpg",
    b"//etc/passwd",
    b"/static/../../../etc/passwd",
    b"/static/%2e%2e/%2e%2e/settings.py",
    b"/..%2f..%2f..%2fetc/passwd",
]


@pytest.mark.parametrize("path", RAW_PATHS, ids=lambda path: path[:40].decode("latin-1"))
@pytest.mark.parametrize("method", [b"GET", b"DELETE"])
def test_names_that_no_client_library_would_send_are_refused(
    process: Process, method: bytes, path: bytes
) -> None:
    answer = raw(process, method + b" " + path + b" HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
    head, _, body = answer.partition(b"\r\n\r\n")
    assert int(head.split()[1]) in (400, 404, 405, 422), answer
    assert b"x-evil" not in head.lower()
    assert b"root:" not in body


@pytest.mark.parametrize("request_line", [b"GET /api/maps/a\x00b HTTP/1.1", b"GET /api/maps/a\nb HTTP/1.1"])
def test_control_characters_in_a_request_line_are_refused(process: Process, request_line: bytes) -> None:
    answer = raw(process, request_line + b"\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
    assert answer.startswith(b"HTTP/1.1 400")


def raw(process: Process, request: bytes) -> bytes:
    """The bytes that come back for these bytes."""
    port = int(process.address.rpartition(":")[2])
    with socket.create_connection(("127.0.0.1", port), timeout=20.0) as connection:
        connection.sendall(request)
        return b"".join(iter(lambda: connection.recv(65_536), b""))


def mark_peak(pid: int) -> bool:
    """Set the mark of highest memory back to what is used now; False where the kernel does not let us."""
    try:
        Path(f"/proc/{pid}/clear_refs").write_text("5")
    except OSError:
        return False
    return True


def peak_mb(pid: int) -> float:
    """Highest resident memory since the mark was set back."""
    status = Path(f"/proc/{pid}/status").read_text()
    return int(status.partition("VmHWM:")[2].split(maxsplit=1)[0]) * 1024 / 1e6


def cpu_seconds(pid: int) -> float:
    """CPU time of a process so far."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
