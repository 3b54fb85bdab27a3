"""Light maps as lists of luminance, and their noise. Python's standard library alone."""
import array
import itertools
import statistics
import struct
import zlib

LUMINANCE = (0.2126, 0.7152, 0.0722)
DARK = 1e-4  # of the mean: texels inside geometry, into which light leaks
MAGIC, ZIP, FLOAT = b"\x76\x2f\x31\x01", b"\x03", 2  # of OpenEXR
LINES = 16  # of a block of ZIP compression


class Map:
    """The luminance of each texel in lux, row by row, top first; None: no light. Where the program has texels: None, not known."""

    def __init__(self, width, height, channels, covered=None):
        self.size, self.covered = (width, height), covered
        r, g, b = LUMINANCE
        values = [r * x + g * y + b * z for x, y, z in zip(*channels)]
        dark = DARK * statistics.fmean(values)
        self.luminance = [value if value > dark else None for value in values]


def read_cycles(path, width, height):
    """What cycles_bake.py writes: RGB and coverage."""
    values = array.array("f")
    with open(path, "rb") as file:
        values.frombytes(file.read())
    return Map(width, height, [values[c::4] for c in range(3)], [value > 0 for value in values[3::4]])


def read_exr(path):
    """An OpenEXR file as afterglow writes it: 32-bit floats B, G, R, blocks of 16 lines with ZIP compression."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != MAGIC:
        raise SystemExit(f"{path}: not an OpenEXR file")
    attributes, offset = exr_header(data)
    if attributes["compression"] != ZIP or exr_channels(attributes["channels"]) != [(name, FLOAT) for name in "BGR"]:
        raise SystemExit(f"{path}: not a light map of afterglow")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = {name: array.array("f") for name in "BGR"}
    for (start,) in struct.iter_unpack("<Q", data[offset:offset + 8 * -(-height // LINES)]):
        first, size = struct.unpack_from("<ii", data, start)
        lines = min(LINES, y1 + 1 - first)
        block = unzip(data[start + 8:start + 8 + size], 12 * width * lines)
        rows = memoryview(block).cast("f")
        for line in range(lines):
            for c, name in enumerate("BGR"):
                at = (3 * line + c) * width
                channels[name].extend(rows[at:at + width])
    return Map(width, height, [channels[name] for name in "RGB"])


def exr_header(data):
    """Attributes by name, and where the table of blocks begins."""
    attributes, at = {}, 8
    while data[at]:
        name, kind, rest = data[at:at + 600].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def exr_channels(text):
    """(name, type) of each channel."""
    channels, at = [], 0
    while text[at]:
        end = text.index(b"\0", at)
        channels.append((text[at:end].decode(), struct.unpack_from("<i", text, end + 1)[0]))
        at = end + 17
    return channels


def unzip(block, size):
    """Undoes ZIP compression of OpenEXR: deflate, differences of bytes, even bytes before odd ones."""
    if len(block) == size:
        return block  # incompressible
    plain = bytes(itertools.accumulate(zlib.decompress(block), lambda sum, next: (sum + next - 128) & 255))
    result = bytearray(size)
    half = (size + 1) // 2
    result[0::2], result[1::2] = plain[:half], plain[half:]
    return bytes(result)


def common_texels(ours, theirs):
    """Indices of the texels that all maps light, and that lie within a chart: the eight around them are texels of Cycles, too. At
    borders the two differ: afterglow averages over the part that the surface covers, Cycles over the whole texel."""
    if len({m.size for m in ours + theirs}) != 1:
        raise SystemExit(f"light maps of different sizes: {[m.size for m in ours + theirs]}")
    width = ours[0].size[0]
    covered = theirs[0].covered
    around = [y * width + x for y in (-1, 0, 1) for x in (-1, 0, 1)]
    lit = zip(*(m.luminance for m in ours + theirs))
    return [i for i, values in enumerate(lit)
            if None not in values and all(0 <= i + step < len(covered) and covered[i + step] for step in around)]


def means(maps, texels):
    return [statistics.fmean(m.luminance[i] for m in maps) for i in texels]


def noise(maps, texels):
    """Variance of a texel between the maps, which differ in their seeds: its mean over the squared mean of all texels, and the
    median over texels of the variance over the squared mean of the texel. Of two maps the variance is half the squared
    difference."""
    mean = means(maps, texels)
    variance = [statistics.variance([m.luminance[i] for m in maps], m_i) for i, m_i in zip(texels, mean)]
    relative = [v / (m * m) for v, m in zip(variance, mean)]
    return statistics.fmean(variance) / statistics.fmean(mean) ** 2, statistics.median(relative)


def difference(a, b, texels):
    """How two programs differ: the ratio of their means, and the median over texels of their ratio."""
    x, y = means(a, texels), means(b, texels)
    return statistics.fmean(x) / statistics.fmean(y), statistics.median(p / q for p, q in zip(x, y))
