"""Reads a table of Airlight's: python3 read_table.py FILE.table prints each axis and field with its unit, length and sum."""

import array
import json
import struct
import sys
import zlib


def read_table(path):
    """The header, and the numbers of each axis and field by name; of a field the last of its axes runs fastest."""
    with open(path, "rb") as file:
        data = file.read()
    signature, version, h, p, crc_h, crc_p = struct.unpack("<8sIIQII", data[:32])
    assert signature == b"\x89AIRL\r\n\x1a" and version == 1 and len(data) == 32 + h + p, f"{path}: no table of version 1"
    header, payload = data[32 : 32 + h], data[32 + h :]
    assert zlib.crc32(header) == crc_h and zlib.crc32(payload) == crc_p, f"{path}: damaged"
    header, numbers = json.loads(header), {}
    for axis in header["axes"]:
        numbers[axis["name"]] = array.array("d", payload[axis["offset"] :][: 8 * axis["length"]])
    for field in header["fields"]:
        kind, size, count = ("f", 4, 1) if field["precision"] == "f32" else ("d", 8, 1)
        for name in field["axes"]:
            count *= len(numbers[name])
        numbers[field["name"]] = array.array(kind, payload[field["offset"] :][: size * count])
    return header, numbers


if __name__ == "__main__":
    header, numbers = read_table(sys.argv[1])
    for one in header["axes"] + header["fields"]:
        values = numbers[one["name"]]
        print(one["name"], one["unit"], len(values), repr(sum(values)), sep="\t")
