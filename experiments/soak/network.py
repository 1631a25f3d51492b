"""A network of this process's own, which can be cut without harm to anybody else's."""

import contextlib
import fcntl
import os
import socket
import struct
import subprocess
import sys
import time

OWN_NETWORK = "TOPNAV_OWN_NETWORK"
"""Set in the process that runs inside the network it may cut."""
SIOCSIFFLAGS = 0x8914  # linux/sockios.h
IFF_UP = 1  # linux/if.h


def enter_own_network() -> bool:
    """Run this command again in a network namespace of its own; False where the system does not allow that.

    Returns True once inside. Its loopback is nobody else's: the console cannot be reached from outside.
    """
    if os.environ.get(OWN_NETWORK):
        _set_loopback(up=True)
        return True
    words = ["unshare", "--net"] if os.geteuid() == 0 else ["unshare", "--user", "--map-root-user", "--net"]
    with contextlib.suppress(OSError):
        if subprocess.run([*words, "true"], capture_output=True, check=False).returncode == 0:
            os.execvpe(words[0], [*words, *sys.orig_argv], os.environ | {OWN_NETWORK: "1"})
    return False


def cut(during_s: float) -> None:
    """Let nothing through for a while, not even from one process to another on this machine."""
    _set_loopback(up=False)
    try:
        time.sleep(during_s)
    finally:
        _set_loopback(up=True)


def _set_loopback(*, up: bool) -> None:
    with socket.socket() as any_socket:
        fcntl.ioctl(any_socket, SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", IFF_UP if up else 0))
