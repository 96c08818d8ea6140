"""Writes a kernel of positions (DAF/SPK, type 2) of sun, Earth, Mars and Moon, without a line of what reads it.

    made_kernel.py FILE FIRST_DAY DAYS     days of TDB since J2000

Earth and Mars go by the mean elements of Standish (1800 to 2050), the Moon on a circle in the ecliptic."""
import math
import struct
import sys

AU_KM = 149597870.7
EARTH = (1.00000261, 0.01671123, -0.00001531, 100.46457166, 102.93768193, 0.0,
         0.00000562, -0.00004392, -0.01294668, 35999.37244981, 0.32327364, 0.0)
MARS = (1.52371034, 0.09339410, 1.84969142, -4.55343205, -23.94362959, 49.55953891,
        0.00001847, 0.00007882, -0.00813131, 19140.30268499, 0.44441088, -0.29257343)


def turned(axis, degrees, v):
    """A vector turned about the axis 0 (x) or 2 (z)."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y, z = v
    return (x, c * y - s * z, s * y + c * z) if axis == 0 else (c * x - s * y, s * x + c * y, z)


def by_elements(of, day):
    a, e, inclination, longitude, perihelion, node = (of[k] + of[k + 6] * day / 36525.0 for k in range(6))
    mean = math.radians((longitude - perihelion) % 360.0)
    eccentric = mean
    for _ in range(50):
        eccentric = mean + e * math.sin(eccentric)
    place = (AU_KM * a * (math.cos(eccentric) - e), AU_KM * a * math.sqrt(1.0 - e * e) * math.sin(eccentric), 0.0)
    return turned(0, 23.43928, turned(2, node, turned(0, inclination, turned(2, perihelion - node, place))))


def moon(day):
    return turned(0, 23.43928, turned(2, 218.3164477 + 13.17639647 * day, (384400.0, 0.0, 0.0)))


def segment(place, first_day, days, coefficients=9):
    words = []
    for k in range(days):
        middle = first_day + k + 0.5
        angles = [math.pi * (node + 0.5) / coefficients for node in range(coefficients)]
        places = [place(middle + 0.5 * math.cos(angle)) for angle in angles]
        words += [86400.0 * middle, 43200.0]
        for c in range(3):
            for j in range(coefficients):
                total = sum(at[c] * math.cos(j * angle) for at, angle in zip(places, angles))
                words.append((1.0 if j == 0 else 2.0) / coefficients * total)
    return words + [86400.0 * first_day, 86400.0, 3.0 * coefficients + 2.0, float(days)]


def main(path, first_day, days):
    bodies = [(10, 0, lambda _: (0.0, 0.0, 0.0)), (399, 10, lambda day: by_elements(EARTH, day)),
              (4, 10, lambda day: by_elements(MARS, day)), (301, 399, moon)]
    segments = [segment(place, first_day, days) for _, _, place in bodies]
    free = 3 * 128 + 1 + sum(map(len, segments))
    record = b"DAF/SPK " + struct.pack("<ii", 2, 6) + b" " * 60 + struct.pack("<iii", 2, 2, free) + b"LTL-IEEE"
    record = record.ljust(699, b"\0") + b"FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xce:ENDFTP"
    summaries = struct.pack("<ddd", 0.0, 0.0, float(len(bodies)))
    word = 3 * 128 + 1
    for (target, centre, _), words in zip(bodies, segments):
        summaries += struct.pack("<dd6i", 86400.0 * first_day, 86400.0 * (first_day + days), target, centre, 1, 2,
                                 word, word + len(words) - 1)
        word += len(words)
    whole = record.ljust(1024, b"\0") + summaries.ljust(1024, b"\0") + (b"made".ljust(40) * len(bodies)).ljust(1024)
    for words in segments:
        whole += struct.pack(f"<{len(words)}d", *words)
    with open(path, "wb") as out:
        out.write(whole.ljust((len(whole) + 1023) // 1024 * 1024, b"\0"))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
