// Reads a recorded flight with the MCAP and ROS 2 message readers of others, and says what is in it.
//
// usage: node read.mjs FILE.mcap
//
// Reads the file twice: in order of the file with every CRC checked, and by its index. Decodes every message by the
// schema in the file, and compares the counts with the file's statistics. Prints one JSON object; exit code 1 if
// anything is wrong.
import { open } from "node:fs/promises";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress as unzstd } from "fzstd";
import lz4 from "lz4js";

const decompressHandlers = {
  zstd: (packed) => unzstd(packed),
  lz4: (packed, size) => lz4.decompress(packed, Number(size)),
};

const faults = [];
const require = (holds, what) => {
  if (!holds && faults.length < 20) faults.push(what);
};

// Decodes the messages of a file, by the schemas that came before them.
class Decoder {
  constructor() {
    this.schemas = new Map();
    this.channels = new Map();
    this.readers = new Map();
    this.topics = {};
    this.messages = 0;
  }
  add(record) {
    if (record.type === "Schema") this.schemas.set(record.id, record);
    if (record.type === "Channel") this.channels.set(record.id, record);
    if (record.type === "Message") this.decode(record);
  }
  readerOf(channel) {
    let reader = this.readers.get(channel.schemaId);
    if (reader == undefined) {
      const schema = this.schemas.get(channel.schemaId);
      require(schema.encoding === "ros2msg", `${schema.name}: encoding ${schema.encoding}`);
      reader = new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true }));
      this.readers.set(channel.schemaId, reader);
    }
    return reader;
  }
  decode(record) {
    const channel = this.channels.get(record.channelId);
    require(channel?.messageEncoding === "cdr", `channel ${record.channelId}: encoding ${channel?.messageEncoding}`);
    const message = this.readerOf(channel).readMessage(record.data);
    const topic = (this.topics[channel.topic] ??= { type: this.schemas.get(channel.schemaId).name, messages: 0 });
    topic.messages += 1;
    topic.last = message;
    this.messages += 1;
    // The stamp that the message carries is the one that the reader finds.
    if (typeof message.stamp_ns === "bigint") require(message.stamp_ns >= 0n, `${channel.topic}: stamp ${message.stamp_ns}`);
  }
}

const file = await open(process.argv[2]);
const bytes = await file.readFile();

const streamed = new Decoder();
let statistics;
const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers });
stream.append(bytes);
for (let record; (record = stream.nextRecord()); ) {
  streamed.add(record);
  if (record.type === "Statistics") statistics = record;
}
require(stream.done(), "the stream reader has not reached the end of the file");
require(statistics != undefined, "there are no statistics");
require(BigInt(streamed.messages) === statistics?.messageCount, `${streamed.messages} messages, statistics say ${statistics?.messageCount}`);
for (const channel of streamed.channels.values()) {
  const counted = statistics?.channelMessageCounts.get(channel.id) ?? 0n;
  require(BigInt(streamed.topics[channel.topic]?.messages ?? 0) === counted, `${channel.topic}: statistics say ${counted}`);
}

const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
};
const index = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const indexed = new Decoder();
indexed.schemas = index.schemasById;
indexed.channels = index.channelsById;
let last = -1n;
for await (const record of index.readMessages()) {
  require(record.logTime >= last, `log time ${record.logTime} after ${last}`);
  last = record.logTime;
  indexed.decode(record);
}
require(indexed.messages === streamed.messages, `${indexed.messages} messages by the index`);
require(index.header.profile === "ros2", `profile ${index.header.profile}`);
require(index.start === undefined || index.start === statistics.messageStartTime, "start time");
const metadata = {};
for await (const record of index.readMetadata()) metadata[record.name] = Object.fromEntries(record.metadata);
const attachments = {};
for await (const record of index.readAttachments({ validateCrcs: true })) attachments[record.name] = record.data.byteLength;

const plain = (_, value) =>
  typeof value === "bigint" ? Number(value) : ArrayBuffer.isView(value) ? Array.from(value, (item) => Number(item)) : value;
console.log(JSON.stringify({ messages: streamed.messages, topics: streamed.topics, metadata, attachments, faults }, plain));
process.exitCode = faults.length === 0 ? 0 : 1;  // process.exit() would cut the output
