// Message definitions of ROS 2 (ros2msg), and messages of these types in CDR.
'use strict';

swiftlet.cdr = (() => {
  // Bytes, and the reading method of DataView.
  const primitives = {
    bool: [1, 'getUint8'], byte: [1, 'getUint8'], char: [1, 'getUint8'], uint8: [1, 'getUint8'], int8: [1, 'getInt8'],
    uint16: [2, 'getUint16'], int16: [2, 'getInt16'], uint32: [4, 'getUint32'], int32: [4, 'getInt32'],
    uint64: [8, 'getBigUint64'], int64: [8, 'getBigInt64'], float32: [4, 'getFloat32'], float64: [8, 'getFloat64'],
  };
  const field = /^([\w/]+)(?:<=\d+)?(?:\[(<=)?(\d*)\])?\s+(\w+)$/;
  const constant = /^\w+(?:<=\d+)?\s+(\w+)\s*=\s*(.+)$/;

  // {fields: [{name, type, kind: 'one' | 'array' | 'sequence', count}], constants: {NAME: text}}
  function struct(lines) {
    const out = {fields: [], constants: {}};
    for (const line of lines) {
      const text = line.replace(/#.*/, '').trim();
      if (!text) continue;
      const named = constant.exec(text);
      if (named) {
        out.constants[named[1]] = named[2].trim();
        continue;
      }
      const [, type, atMost, count, name] = field.exec(text) ?? (() => { throw new Error(`definition: ${text}`); })();
      const kind = count === undefined ? 'one' : atMost || count === '' ? 'sequence' : 'array';
      out.fields.push({name, type, kind, count: Number(count)});
    }
    return out;
  }

  // The struct of a definition, with those that it uses in `types`.
  function parse(definition) {
    const [first, ...others] = definition.split(/^=+$/m).map((part) => part.trim().split('\n'));
    const root = struct(first);
    root.types = {};
    for (const [head, ...lines] of others) root.types[head.replace('MSG:', '').trim()] = struct(lines);
    return root;
  }

  class Reader {
    constructor(view) {
      this.view = view;
      this.little = (view.getUint8(1) & 1) === 1;
      this.at = 4;  // behind the encapsulation header, from which alignment counts
    }
    primitive(type) {
      const [size, method] = primitives[type];
      this.at += (size - (this.at - 4) % size) % size;
      const value = this.view[method](this.at, this.little);
      this.at += size;
      if (type === 'bool') return value !== 0;
      return typeof value === 'bigint' ? Number(value) : value;
    }
    string() {
      const length = this.primitive('uint32');
      const bytes = new Uint8Array(this.view.buffer, this.view.byteOffset + this.at, Math.max(0, length - 1));
      this.at += length;
      return new TextDecoder().decode(bytes);
    }
    value(type, types) {
      if (type === 'string') return this.string();
      return type in primitives ? this.primitive(type) : this.struct(types[type], types);
    }
    struct(of, types) {
      const out = {};
      for (const {name, type, kind, count} of of.fields) {
        if (kind === 'one') {
          out[name] = this.value(type, types);
        } else {
          const length = kind === 'array' ? count : this.primitive('uint32');
          out[name] = Array.from({length}, () => this.value(type, types));
        }
      }
      return out;
    }
  }

  // view: DataView of the message with its encapsulation header. 64-bit integers become numbers.
  const read = (root, view) => new Reader(view).struct(root, root.types);

  // The names of the numbers in a message: "position_ned[2]", "request.id"; none of sequences.
  function signals(root) {
    const names = [];
    const add = (name, type) => {
      if (type in primitives) names.push(name);
      else if (type !== 'string') visit(root.types[type], `${name}.`);
    };
    const visit = (of, prefix) => {
      for (const {name, type, kind, count} of of.fields) {
        if (kind === 'one') add(prefix + name, type);
        if (kind === 'array') for (let i = 0; i < count; ++i) add(`${prefix}${name}[${i}]`, type);
      }
    };
    visit(root, '');
    return names;
  }

  // A function that gives the number of this name in a message.
  function signal(name) {
    const path = name.replace(/\[(\d+)\]/g, '.$1').split('.');
    return (message) => Number(path.reduce((value, key) => value[key], message));
  }

  // The name of a constant with this value: "taking off" of MODE_TAKING_OFF=2 with the prefix "MODE_".
  function constantName(root, prefix, value) {
    const found = Object.entries(root.constants).find(([name, text]) => name.startsWith(prefix) && Number(text) === value);
    return found ? found[0].slice(prefix.length).toLowerCase().replaceAll('_', ' ') : String(value);
  }

  return {parse, read, signals, signal, constantName};
})();
