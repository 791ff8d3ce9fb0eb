"""Rewrites a recording of Furrow as the recorders of ROS 2 (SQLite) and of ROS 1 write theirs.

The MCAP file must not be compressed. The code here shares nothing with Furrow's readers.
"""

import pathlib
import sqlite3
import struct
import sys

RECORDING = pathlib.Path(__file__).resolve().parents[2] / "packages" / "furrow_recording"
sys.path[:0] = [str(RECORDING / "test" / "conformance"), str(RECORDING / "fuzz")]
import generate  # noqa: E402
import make_seeds  # noqa: E402

NUMBERS = {"bool": "?", "byte": "B", "char": "B", "uint8": "B", "int8": "b", "uint16": "H",
           "int16": "h", "uint32": "I", "int32": "i", "uint64": "Q", "int64": "q", "float32": "f",
           "float64": "d"}
# ROS 1 has types of its own for these.
BUILT_IN = {"builtin_interfaces/Time": "time", "builtin_interfaces/Duration": "duration"}
LATCHED_PROFILE = "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"
VOLATILE_PROFILE = "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n"
BAG_CHUNK_BYTES = 768 * 1024


def mcap_records(data, at, end):
    while at < end:
        opcode, length = struct.unpack_from("<BQ", data, at)
        at += 9
        yield opcode, data[at:at + length]
        at += length


def take_text(data, at):
    (length,) = struct.unpack_from("<I", data, at)
    return data[at + 4:at + 4 + length], at + 4 + length


class Recording:
    """The channels and messages of an MCAP file without compression, in the file's order."""

    def __init__(self, path):
        self.schemas, self.channels, self.messages = {}, {}, []
        data = pathlib.Path(path).read_bytes()
        for opcode, content in mcap_records(data, len(generate.MAGIC),
                                            len(data) - len(generate.MAGIC)):
            if opcode == generate.DATA_END:
                break
            if opcode == generate.CHUNK:
                compression, at = take_text(content, 28)
                if compression:
                    raise ValueError("the recording is compressed")
                for record in mcap_records(content, at + 8, len(content)):
                    self.add(*record)
            else:
                self.add(opcode, content)

    def add(self, opcode, content):
        if opcode == generate.SCHEMA:
            name, at = take_text(content, 2)
            _, at = take_text(content, at)
            definition, _ = take_text(content, at)
            number = struct.unpack_from("<H", content)[0]
            self.schemas[number] = (name.decode(), definition.decode())
        elif opcode == generate.CHANNEL:
            number, schema = struct.unpack_from("<HH", content)
            topic, at = take_text(content, 4)
            _, at = take_text(content, at)
            self.channels[number] = (topic.decode(), schema, b"durability: 1" in content[at:] or
                                     b"transient_local" in content[at:])
        elif opcode == generate.MESSAGE:
            channel, _, time, _ = struct.unpack_from("<HIQQ", content)
            self.messages.append((channel, time, content[22:]))


def write_rosbag2(recording, folder):
    """A folder with metadata.yaml and one SQLite file."""
    folder.mkdir()
    database = sqlite3.connect(folder / "run_0.db3")
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, "
                     "serialization_format TEXT, offered_qos_profiles TEXT)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, "
                     "timestamp INTEGER, data BLOB)")
    database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    for number, (topic, schema, latched) in recording.channels.items():
        database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', ?)",
                         (number, topic, recording.schemas[schema][0],
                          LATCHED_PROFILE if latched else VOLATILE_PROFILE))
    database.executemany("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)",
                         recording.messages)
    database.commit()
    database.close()
    (folder / "metadata.yaml").write_text(
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
        "  relative_file_paths:\n    - run_0.db3\n")
    return folder


def ros1_name(name):
    return name.replace("/msg/", "/")


class Type:
    """A ROS 2 message type by its definition: serializes CDR messages as ROS 1 does."""

    def __init__(self, name, definition):
        self.name = ros1_name(name)
        self.fields = {}
        parts = definition.split("=" * 80)
        self.read(self.name, parts[0])
        for part in parts[1:]:
            header, _, body = part.strip().partition("\n")
            self.read(ros1_name(header.removeprefix("MSG:").strip()), body)

    def read(self, name, body):
        fields = self.fields[name] = []
        for line in body.splitlines():
            words = line.partition("#")[0].split()
            if len(words) < 2 or "=" in words[1] or words[2:3] == ["="]:
                continue  # a comment or a constant
            kind, _, count = words[0].partition("[")
            kind = ros1_name(kind.partition("<=")[0])
            if "/" not in kind and kind not in NUMBERS and kind != "string":
                kind = name.partition("/")[0] + "/" + kind
            fields.append((kind, None if not count else count.rstrip("]"), words[1]))

    def definition(self):
        """As bags carry it; without the types that ROS 1 has built in."""
        texts = []
        for name, fields in self.fields.items():
            if name in BUILT_IN:
                continue
            lines = ["uint32 seq"] if name == "std_msgs/Header" else []
            for kind, count, field in fields:
                array = "" if count is None else "[" + (count if count.isdigit() else "") + "]"
                lines.append(f"{BUILT_IN.get(kind, kind)}{array} {field}")
            text = "\n".join(lines) + "\n"
            texts.append(text if name == self.name else f"MSG: {name}\n{text}")
        return ("=" * 80 + "\n").join(texts)

    def to_ros1(self, payload):
        self.data, self.at, self.out = payload[4:], 0, bytearray()
        self.message(self.name)
        return bytes(self.out)

    def number(self, code):
        size = struct.calcsize("<" + code)
        self.at = (self.at + size - 1) // size * size
        (value,) = struct.unpack_from("<" + code, self.data, self.at)
        self.at += size
        return value

    def message(self, name):
        if name == "std_msgs/Header":
            self.out += struct.pack("<I", 7)  # seq, which ROS 2 does not have
        for kind, count, _ in self.fields[name]:
            if count is None:
                self.value(kind, 1)
            elif count.isdigit():
                self.value(kind, int(count))
            else:
                elements = self.number("I")
                self.out += struct.pack("<I", elements)
                self.value(kind, elements)

    def value(self, kind, times):
        code = NUMBERS.get(kind)
        for _ in range(times):
            if code:
                self.out += struct.pack("<" + code, self.number(code))
            elif kind == "string":
                length = self.number("I")
                self.out += struct.pack("<I", length - 1) + self.data[self.at:self.at + length - 1]
                self.at += length
            else:
                self.message(kind)


def write_bag(recording, path):
    """A ROS 1 bag of several bz2 chunks."""
    types = {number: Type(*schema) for number, schema in recording.schemas.items()}
    connections = {}
    for number, (topic, schema, latched) in recording.channels.items():
        kind = types[schema]
        more = {"latching": b"1"} if latched else {}
        connections[number] = make_seeds.connection(number, topic.encode(), kind.name.encode(),
                                                    kind.definition(), **more)
    messages = []
    for channel, time, payload in recording.messages:
        stamp = struct.pack("<II", *divmod(time, 10**9))
        data = types[recording.channels[channel][1]].to_ros1(payload)
        messages.append((channel, stamp, data))
    path.write_bytes(make_seeds.bag(connections, messages, BAG_CHUNK_BYTES, b"bz2"))
    return path
