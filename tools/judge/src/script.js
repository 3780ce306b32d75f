// The input of a run: the voltages at the analogue pins, and the serial bytes with their arrival cycles.

const LINE = /^analogue (?<pin>1[4-9]) (?<mv>\d+)$|^(?<cycle>\d+) (?<byte>[0-9a-f]{2})$|^end (?<end>\d+)$/;

/**
 * Parses a script. `analogue <pin, 14 to 19> <mV>` sets the voltage at one of A0 to A5. `<cycle> <two hex digits>` is
 * a byte whose reception ends at that cycle; bytes are in chronological order. The last line is `end <cycle>`. Throws
 * an error that names the faulty line.
 */
export function parseScript(text) {
  const voltages = [];
  const bytes = [];
  let endCycle;
  text.split('\n').forEach((line, index) => {
    if (line === '') return;
    const makeError = (problem) => new Error(`line ${index + 1} of the script ${problem}: ${JSON.stringify(line)}`);
    if (endCycle !== undefined) throw makeError('follows `end`');
    const { pin, mv, cycle, byte, end } = LINE.exec(line)?.groups ?? {};
    if (pin) {
      voltages.push({ channel: pin - 14, volts: mv / 1000 });
    } else if (cycle) {
      if (Number(cycle) < (bytes.at(-1)?.cycle ?? 0)) throw makeError('is earlier than the previous byte');
      bytes.push({ cycle: Number(cycle), byte: parseInt(byte, 16) });
    } else if (end) {
      endCycle = Number(end);
    } else {
      throw makeError('must be `analogue <pin> <mV>`, `<cycle> <hex byte>` or `end <cycle>`');
    }
  });
  if (endCycle === undefined) throw new Error('the script has no `end <cycle>`');
  return { voltages, bytes, endCycle };
}
