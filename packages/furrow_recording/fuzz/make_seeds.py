#!/usr/bin/env python3
"""Writes the seeds of the fuzz targets: small valid files of each kind.

    make_seeds.py FOLDER

tools/fuzz.sh and bag_test call it. Inputs that fuzzing found are kept in findings/TARGET/.
"""

import argparse
import bz2
import pathlib
import sqlite3
import struct
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "test" / "conformance"))
import generate  # noqa: E402

LINE = "=" * 80
HEADER = "uint32 seq\ntime stamp\nstring frame_id\n"
IMU = ("Header header\nfloat64[9] cov\nVector3[] axes\nstring[] names\nbool ok\nduration age\n" +
       LINE + "\nMSG: std_msgs/Header\n" + HEADER +
       LINE + "\nMSG: p/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n")
LOG = ("Header header\nbyte level\nstring name\nstring msg\nstring file\nstring function\n"
       "uint32 line\nstring[] topics\n" + LINE + "\nMSG: std_msgs/Header\n" + HEADER)
QOS = "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"


def mcap_seeds():
    wanted = {"TenMessages-ch-chx-mx-rch-rsh-st-sum", "TenMessages", "OneMessage-ch-chx-mx-st",
              "OneAttachment-ax-st-sum", "OneMetadata-mdx-pad-st", "NoData", "OneMessage-ch-pad"}
    for name, records, features in generate.variants():
        if name in wanted:
            data = generate.File(records, features).build()
            yield name, data
            # Fuzzing gets nowhere behind CRCs: the same without.
            yield name + "-nocrc", without_crcs(data)


def without_crcs(data):
    data = bytearray(data)
    at = len(generate.MAGIC)
    while at + 9 <= len(data) - len(generate.MAGIC):
        opcode, length = struct.unpack_from("<BQ", data, at)
        content = at + 9
        if opcode == generate.CHUNK:
            data[content + 24:content + 28] = bytes(4)
        elif opcode == generate.DATA_END:
            data[content:content + 4] = bytes(4)
        elif opcode == generate.FOOTER:
            data[content + 16:content + 20] = bytes(4)
        at = content + length
    return bytes(data)


def fields(**values):
    text = b"".join(u32(len(name) + 1 + len(value)) + name.encode() + b"=" + value
                    for name, value in values.items())
    return struct.pack("<I", len(text)) + text


def record(data, **values):
    return fields(**values) + struct.pack("<I", len(data)) + data


def u32(value):
    return struct.pack("<I", value)


def connection(number, topic, kind, definition, **more):
    header = fields(topic=topic, type=kind, md5sum=b"*", message_definition=definition.encode(),
                    callerid=b"/n", **more)
    return record(header[4:], op=b"\x07", conn=u32(number), topic=topic)


def bag_chunk(at, content, index, compression):
    """A chunk with its indexes, and the record that describes it at the end of the file."""
    packed = bz2.compress(content) if compression == b"bz2" else content
    body = record(packed, op=b"\x05", compression=compression, size=u32(len(content)))
    counts = b""
    for number, entries in index.items():
        counts += u32(number) + u32(len(entries))
        body += record(b"".join(time + u32(offset) for time, offset in entries), op=b"\x04",
                       ver=u32(1), conn=u32(number), count=u32(len(entries)))
    times = [time for entries in index.values() for time, _ in entries]
    info = record(counts, op=b"\x06", ver=u32(1), chunk_pos=struct.pack("<Q", at),
                  start_time=min(times, key=seconds_first), end_time=max(times, key=seconds_first),
                  count=u32(len(index)))
    return body, info


def seconds_first(time):
    return struct.unpack("<II", time)


def bag(connections, messages, chunk_bytes, compression, closed=True):
    """A bag of `connections`, records by number, and `messages`: number, time and data."""
    start = b"#ROSBAG V2.0\n"

    def bag_header(position, chunks):
        # Without the usual padding to 4096 bytes, which no reader needs.
        return record(b"", op=b"\x03", index_pos=struct.pack("<Q", position),
                      conn_count=u32(len(connections)), chunk_count=u32(chunks))
    first = len(start) + len(bag_header(0, 0))
    body, infos, chunks = b"", b"", 0
    content, index = b"".join(connections.values()), {}
    for i, (number, time, data) in enumerate(messages):
        index.setdefault(number, []).append((time, len(content)))
        content += record(data, op=b"\x02", conn=u32(number), time=time)
        if len(content) >= chunk_bytes or i + 1 == len(messages):
            chunk, info = bag_chunk(first + len(body), content, index, compression)
            body, infos, chunks = body + chunk, infos + info, chunks + 1
            content, index = b"", {}
    if not closed:
        return start + bag_header(0, chunks) + body
    return (start + bag_header(first + len(body), chunks) + body + b"".join(connections.values()) +
            infos)


def bag_seed(compression, closed):
    text = struct.pack("<I", 2) + b"hi"
    imu = (struct.pack("<IIII", 1, 2, 3, 1) + b"f" + bytes(72) + u32(1) + bytes(24) + u32(1) +
           u32(1) + b"n" + b"\x01" + struct.pack("<ii", -1, 5))
    connections = {0: connection(0, b"/s", b"std_msgs/String", "string data\n", latching=b"1"),
                   1: connection(1, b"/imu", b"p/Imu", IMU)}
    messages = [(number, struct.pack("<II", 10 - i, 5), data)
                for i, (number, data) in enumerate([(0, text), (1, imu), (0, text)])]
    return bag(connections, messages, 1 << 20, compression, closed)


def db3_seed(definitions):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "seed.db3"
        database = sqlite3.connect(path)
        database.execute("PRAGMA page_size=512")
        database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, "
                         "serialization_format TEXT, offered_qos_profiles TEXT)")
        database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, "
                         "timestamp INTEGER, data BLOB)")
        if definitions:
            database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
            database.execute("CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type "
                             "TEXT, encoding TEXT, encoded_message_definition TEXT, hash TEXT)")
            database.execute("INSERT INTO message_definitions VALUES "
                             "(1, 'std_msgs/msg/String', 'ros2msg', 'string data', '')")
        database.execute("INSERT INTO topics VALUES (1, '/a', 'std_msgs/msg/String', 'cdr', ?)",
                         (QOS,))
        data = b"\0\1\0\0\2\0\0\0x\0"
        for time in (30, 10, 20):
            database.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (1, ?, ?)",
                             (time, data))
        database.commit()
        database.close()
        return path.read_bytes()


def message_seeds():
    imu = (struct.pack("<IIII", 1, 2, 3, 1) + b"f" + bytes(72) + u32(1) + bytes(24) + u32(1) +
           u32(1) + b"n" + b"\x01" + struct.pack("<ii", -1, 5))
    yield "ros1", b"ros1\n" + IMU.encode() + b"\0" + imu
    log = struct.pack("<IIII", 1, 2, 3, 0) + b"\x08" + u32(0) * 4 + u32(7) + u32(0)
    yield "ros1_log", b"ros1\n" + LOG.encode() + b"\0" + log
    cdr = b"\0\1\0\0" + struct.pack("<iIII", 1, 2, 2, 0)[:12] + b"f\0\0\0" + u32(1) + b"\1\0\0\0"
    yield "ros2msg", (b"ros2msg\nbuiltin_interfaces/Time stamp\nstring<=5 f\nuint8[<=4] d\n"
                      b"int32 X=5\nbool b true\n\0" + cdr)
    idl = b"module p { module msg { struct T { long a; sequence<double> b; string c; }; }; };"
    yield "omgidl", b"omgidl\n" + idl + b"\0\0\0\0\0" + struct.pack(">iI", 1, 0) + u32(0)


def yaml_seeds():
    yield "metadata", (b"rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
                       b"  compression_format: zstd\n  compression_mode: FILE\n"
                       b"  relative_file_paths:\n    - a_0.db3.zstd\n")
    yield "qos", (QOS + "  deadline:\n    sec: 1\n    nsec: 5\n").encode()
    yield "words", b"- history: keep_last\n  depth: 5\n  reliability: best_effort\n"
    yield "flags", b"reliability: true\ndurability: false\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    seeds = {
        "mcap": mcap_seeds(),
        "bag": ((f"{c.decode()}{'' if closed else '-open'}", bag_seed(c, closed))
                for c in (b"none", b"bz2") for closed in (True, False)),
        "db3": ((name, db3_seed(name == "new")) for name in ("new", "old")),
        "message": message_seeds(),
        "yaml": yaml_seeds(),
    }
    for target, files in seeds.items():
        (folder / target).mkdir(parents=True, exist_ok=True)
        for name, data in files:
            (folder / target / f"seed-{name}").write_bytes(data)


if __name__ == "__main__":
    main()
