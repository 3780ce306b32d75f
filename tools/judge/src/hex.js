/** Loads the text of an Intel HEX file into the Uint8Array `flash`. Throws an error that names the faulty line. */
export function loadHex(text, flash) {
  let baseAddress = 0;
  let hasEnded = false;
  text.split(/\r?\n/).forEach((line, index) => {
    if (line === '' || hasEnded) return;
    const makeError = (problem) => new Error(`line ${index + 1} of the HEX file ${problem}`);
    if (!/^:([0-9a-f]{2}){5,}$/i.test(line)) throw makeError('is not a record');
    const bytes = Uint8Array.from(line.slice(1).match(/../g), (pair) => parseInt(pair, 16));
    if (bytes.reduce((sum, byte) => (sum + byte) & 0xff, 0) !== 0) throw makeError('has a wrong checksum');
    if (bytes.length !== bytes[0] + 5) throw makeError('has a wrong length');
    const address = baseAddress + (bytes[1] << 8) + bytes[2];
    const data = bytes.subarray(4, -1);
    const upperAddress = (data[0] << 8) + data[1];
    const type = bytes[3];
    if (type === 0) {
      if (address + data.length > flash.length) throw makeError('is beyond the flash');
      flash.set(data, address);
    } else if (type === 1) {
      hasEnded = true;
    } else if (type === 2) {
      baseAddress = upperAddress << 4;
    } else if (type === 4) {
      baseAddress = upperAddress * 0x10000;
    } else if (type > 5) {
      // Types 3 and 5 are start addresses, which the chip does not use.
      throw makeError('has an unknown type');
    }
  });
  if (!hasEnded) throw new Error('the HEX file has no end record');
}
