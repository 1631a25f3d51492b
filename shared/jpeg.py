"""What a JPEG says of itself, without decoding it. Pure."""

END_MARK = b"\xff\xd9"
TAIL_BYTES = 64
"""Chosen: some cameras fill up what follows the end marker."""


class BadPictureError(ValueError):
    """Bytes that hold no usable picture; the text says why."""


def jpeg_size(data: bytes) -> tuple[int, int]:
    """Width and height from a JPEG's frame header (ITU-T T.81, B.2.2), without decoding it.

    Raises:
        BadPictureError: there is no such header.
    """
    if data[:2] != b"\xff\xd8":
        raise BadPictureError("not a JPEG: it must start with FF D8")
    position = 2
    while position + 9 <= len(data):
        if data[position] != 0xFF:
            break
        marker = data[position + 1]
        if (
            marker == 0xFF or marker == 0x01 or 0xD0 <= marker <= 0xD7
        ):  # fill bytes and markers without a length
            position += 1 if marker == 0xFF else 2
            continue
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            height = int.from_bytes(data[position + 5 : position + 7])
            width = int.from_bytes(data[position + 7 : position + 9])
            return width, height
        position += 2 + int.from_bytes(data[position + 2 : position + 4])
    raise BadPictureError("not a JPEG: no frame header with its size")


def require_whole(data: bytes) -> None:
    """Do nothing where a JPEG has its end.

    Raises:
        BadPictureError: it is cut short.
    """
    if END_MARK not in data[-TAIL_BYTES:]:
        raise BadPictureError("JPEG is cut short: no end marker, send it again")
