"""Readers of PNG, OpenEXR and TGA files that share no code with the writers of Sabi: numpy and zlib alone."""

import struct
import zlib

import numpy


def read(path):
    """Returns the samples of a file as an array of rows, columns and channels: whole numbers as stored, floats as they are."""
    data = path.read_bytes()
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        return read_png(data)[0]
    if data.startswith(b"\x76\x2f\x31\x01"):
        return read_exr(data)
    return read_tga(data)


def png_chunks(data):
    """Returns the kinds and contents of the chunks of a PNG file, whose checksums are checked."""
    chunks, at = [], 8
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        kind, content = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        (checksum,) = struct.unpack(">I", data[at + 8 + length : at + 12 + length])
        assert zlib.crc32(kind + content) == checksum, f"checksum of {kind}"
        chunks.append((kind.decode("latin-1"), content))
        at += 12 + length
    return chunks


def read_png(data):
    """Returns samples and chunks of a PNG file (PNG 1.2, section 6 for the filters)."""
    chunks = png_chunks(data)
    width, height, bits, kind, *_ = struct.unpack(">IIBBBBB", chunks[0][1])
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[kind]
    raw = zlib.decompress(b"".join(content for name, content in chunks if name == "IDAT"))
    pixel = channels * bits // 8
    row_bytes = width * pixel
    rows = numpy.frombuffer(raw, numpy.uint8).reshape(height, row_bytes + 1)
    above = numpy.zeros(row_bytes, numpy.uint8)
    samples = numpy.zeros((height, row_bytes), numpy.uint8)
    for y in range(height):
        above = unfiltered(int(rows[y, 0]), rows[y, 1:], above, pixel)
        samples[y] = above
    dtype = numpy.uint8 if bits == 8 else numpy.dtype(">u2")
    return samples.reshape(height, -1).view(dtype).reshape(height, width, channels).astype(numpy.int64), chunks


def unfiltered(method, row, above, pixel):
    """Returns the bytes of a filtered row."""
    row = row.astype(numpy.int64)
    if method == 0:
        return row.astype(numpy.uint8)
    if method == 2:
        return ((row + above) & 255).astype(numpy.uint8)
    if method == 1:
        sums = row.reshape(-1, pixel).cumsum(axis=0) & 255
        return sums.reshape(-1).astype(numpy.uint8)
    found, up = [0] * len(row), above.tolist()
    for index, value in enumerate(row.tolist()):
        left = found[index - pixel] if index >= pixel else 0
        corner = up[index - pixel] if index >= pixel else 0
        found[index] = (value + predicted(method, left, up[index], corner)) & 255
    return numpy.array(found, numpy.uint8)


def predicted(method, left, up, corner):
    if method == 3:
        return (left + up) // 2
    paeth = left + up - corner
    distances = [abs(paeth - left), abs(paeth - up), abs(paeth - corner)]
    return (left, up, corner)[distances.index(min(distances))]


def read_exr(data):
    """Returns the samples of an OpenEXR file of scan lines with ZIP ("OpenEXR File Layout"), in the order R, G, B, A or Y."""
    channels, box, compression, at = [], None, None, 8
    while data[at] != 0:
        name, at = text(data, at)
        kind, at = text(data, at)
        (length,) = struct.unpack("<i", data[at : at + 4])
        value, at = data[at + 4 : at + 4 + length], at + 4 + length
        if name == "channels":
            start = 0
            while value[start] != 0:
                channel, start = text(value, start)
                (pixel,) = struct.unpack("<i", value[start : start + 4])
                channels.append((channel, {1: "<f2", 2: "<f4"}[pixel]))
                start += 16
        elif name == "dataWindow":
            box = struct.unpack("<4i", value)
        elif name == "compression":
            compression = value[0]
    at += 1
    assert compression == 3, "ZIP of 16 lines"
    width, height = box[2] - box[0] + 1, box[3] - box[1] + 1
    planes = {name: numpy.zeros((height, width)) for name, _ in channels}
    line_bytes = sum(numpy.dtype(kind).itemsize * width for _, kind in channels)
    for block in range((height + 15) // 16):
        (offset,) = struct.unpack("<Q", data[at + 8 * block : at + 8 * block + 8])
        first, length = struct.unpack("<ii", data[offset : offset + 8])
        lines = min(16, height - first)
        content = data[offset + 8 : offset + 8 + length]
        if length < lines * line_bytes:
            content = unpredicted(zlib.decompress(content))
        start = 0
        for y in range(first, first + lines):
            for name, kind in channels:
                size = numpy.dtype(kind).itemsize * width
                planes[name][y] = numpy.frombuffer(content[start : start + size], kind)
                start += size
    names = [name for name in "RGBAY" if name in planes]
    return numpy.stack([planes[name] for name in names], axis=-1)


def unpredicted(content):
    """Undoes the differences and the split into halves that ZIP has in OpenEXR."""
    differences = numpy.frombuffer(content, numpy.uint8).astype(numpy.int64)
    differences[1:] -= 128
    values = (differences.cumsum() & 255).astype(numpy.uint8)
    joined = numpy.empty_like(values)
    half = (len(values) + 1) // 2
    joined[0::2], joined[1::2] = values[:half], values[half:]
    return joined.tobytes()


def text(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def read_tga(data):
    """Returns the samples of a TGA file without a palette in the order R, G, B, A (Truevision TGA 2.0)."""
    id_length, _, kind = data[0], data[1], data[2]
    width, height = struct.unpack("<HH", data[12:16])
    channels, descriptor = data[16] // 8, data[17]
    assert kind in (2, 3, 10, 11), f"kind {kind}"
    pixels, most = data[18 + id_length :], width * height * channels
    pixels = runs_undone(pixels, channels, most) if kind >= 10 else pixels[:most]
    samples = numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, channels).astype(numpy.int64)
    if not descriptor & 32:
        samples = samples[::-1]
    if channels >= 3:
        samples = numpy.concatenate([samples[..., 2::-1], samples[..., 3:]], axis=-1)
    return samples


def runs_undone(packets, pixel, most):
    """Returns the bytes of packets, each of which repeats a pixel or lists some."""
    found, at = bytearray(), 0
    while len(found) < most:
        count, repeats = (packets[at] & 127) + 1, packets[at] & 128
        length = pixel if repeats else pixel * count
        found += packets[at + 1 : at + 1 + length] * (count if repeats else 1)
        at += 1 + length
    return bytes(found)
