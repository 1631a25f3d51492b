"""Ports for stacks: free, different, and out of reach of what the kernel gives away."""

import socket

from services.launcher.processes import free_ports as module
from services.launcher.processes.free_ports import FIRST, HOST, free_ports


def ephemeral(tmp_path, first):
    path = tmp_path / "range"
    path.write_text(f"{first}\t60999\n")
    return path


def test_ports_lie_below_the_ephemeral_range(tmp_path):
    ports = free_ports(20, ephemeral(tmp_path, FIRST + 1000))
    assert len(set(ports)) == 20
    assert all(FIRST <= port < FIRST + 1000 for port in ports)


def test_ports_of_this_machine_can_be_listened_on():
    for port in free_ports(3):
        with socket.socket() as server:
            server.bind((HOST, port))
            server.listen()


def test_a_taken_port_is_not_given(tmp_path, monkeypatch):
    with socket.socket() as taken:
        taken.bind((HOST, 0))
        port = taken.getsockname()[1]
        monkeypatch.setattr(module, "FIRST", port)
        assert free_ports(1, ephemeral(tmp_path, port + 1)) != [port]


def test_the_kernel_chooses_where_its_range_leaves_no_room(tmp_path):
    assert len(set(free_ports(3, ephemeral(tmp_path, 1024)))) == 3


def test_systems_without_the_file_get_ports_all_the_same(tmp_path):
    assert len(set(free_ports(3, tmp_path / "missing"))) == 3
