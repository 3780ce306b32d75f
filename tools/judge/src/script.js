// The input of a run: the voltages at the analogue pins, and the serial bytes with their arrival cycles.

/**
 * Parses a script. `analogue <pin, 14 to 19> <mV>` sets the voltage at one of A0 to A5. `<cycle> <two hex digits>` is
 * a byte whose reception ends at that cycle; bytes are in chronological order. The last line is `end <cycle>`. Throws
 * an error that names the faulty line.
 */
export function readScript(text) {
  const analogue = [];
  const bytes = [];
  let endCycle;
  text.split('\n').forEach((line, index) => {
    if (line === '') return;
    const makeError = (problem) => new Error(`line ${index + 1} of the script ${problem}: ${JSON.stringify(line)}`);
    if (endCycle !== undefined) throw makeError('follows `end`');
    const [, pin, mv] = /^analogue (1[4-9]) (\d+)$/.exec(line) ?? [];
    if (pin !== undefined) {
      analogue.push({ channel: pin - 14, volts: mv / 1000 });
      return;
    }
    const match = /^(\d+) ([0-9a-f]{2})$|^end (\d+)$/.exec(line);
    if (!match) throw makeError('must be `analogue <pin> <mV>`, `<cycle> <hex byte>` or `end <cycle>`');
    if (match[3] !== undefined) {
      endCycle = Number(match[3]);
      return;
    }
    const cycle = Number(match[1]);
    if (cycle < (bytes.at(-1)?.cycle ?? 0)) throw makeError('is earlier than the previous byte');
    bytes.push({ cycle, byte: parseInt(match[2], 16) });
  });
  if (endCycle === undefined) throw new Error('the script has no `end <cycle>`');
  return { analogue, bytes, endCycle };
}
