// Reads ROS 1 bags with @foxglove/rosbag, or with --db3 rosbag2 files with @foxglove/rosbag2. Prints a
// line per message, as read.cjs does of MCAP files: topic, time, content as JSON. ROS 1 content is
// printed in its ROS 2 form. Usage: node read_bag.cjs [--db3] FILE...
"use strict";

const fs = require("fs");

/// Headers lose "seq", times are {sec, nanosec}, and names are lower case.
function asRos2(value) {
  if (ArrayBuffer.isView(value)) {
    return Array.from(value, (item) => (typeof item === "bigint" ? item.toString() : item));
  }
  if (Array.isArray(value)) {
    return value.map(asRos2);
  }
  if (typeof value === "bigint") {
    return value.toString();
  }
  if (value === null || typeof value !== "object") {
    return value;
  }
  const keys = Object.keys(value);
  if (keys.length === 2 && keys[0] === "sec" && keys[1] === "nsec") {
    return { sec: value.sec, nanosec: value.nsec };
  }
  const isHeader = keys.join() === "seq,stamp,frame_id";
  return Object.fromEntries(
    keys.filter((key) => !(isHeader && key === "seq"))
      .map((key) => [key.toLowerCase(), asRos2(value[key])]));
}

function nanoseconds(time) {
  return (BigInt(time.sec) * 1_000_000_000n + BigInt(time.nsec)).toString();
}

async function readBag(file) {
  const { Bag } = require("@foxglove/rosbag");
  const { FileReader } = require("@foxglove/rosbag/node");
  const Bzip2 = require("@foxglove/wasm-bz2");
  const lz4 = require("@foxglove/wasm-lz4");
  const bzip2 = await Bzip2.init();
  await lz4.isLoaded;
  const bag = new Bag(new FileReader(file), {
    decompress: {
      bz2: (data, size) => bzip2.decompress(data, size),
      lz4: (data, size) => lz4(data, size),
    },
  });
  await bag.open();
  for await (const message of bag.messageIterator()) {
    const content = JSON.stringify(asRos2(message.message));
    console.log(message.topic, nanoseconds(message.timestamp), content);
  }
}

async function readDb3(file) {
  const { Rosbag2 } = require("@foxglove/rosbag2");
  const { SqliteSqljs } = require("@foxglove/rosbag2-web");
  const wasm = require.resolve("@foxglove/sql.js/dist/sql-wasm.wasm");
  await SqliteSqljs.Initialize({ wasmBinary: fs.readFileSync(wasm) });
  const bag = new Rosbag2([new SqliteSqljs(new Uint8Array(fs.readFileSync(file)))]);
  await bag.open();
  const lines = [];
  for await (const message of bag.readMessages()) {
    const time = nanoseconds(message.timestamp);
    lines.push([BigInt(time), `${message.topic.name} ${time} ${JSON.stringify(asRos2(message.value))}`]);
  }
  lines.sort((a, b) => (a[0] < b[0] ? -1 : a[0] > b[0] ? 1 : 0));
  lines.forEach(([, line]) => console.log(line));
}

async function main() {
  const files = process.argv.slice(2);
  const read = files[0] === "--db3" ? readDb3 : readBag;
  for (const file of files.filter((name) => name !== "--db3")) {
    await read(file);
  }
}

main().catch((error) => {
  console.error(error.message);
  process.exitCode = 1;
});
