// The input of a run: voltages at the analogue pins, and bytes for the serial line with their cycles.

/**
 * Reads a script: lines `analogue <pin, 14 to 19> <mV>`, the voltages at A0 to A5; lines
 * `<cycle> <two hex digits>` in chronological order, bytes whose reception ends at that cycle;
 * and last `end <cycle>`. Throws an error that names the line.
 */
export function readScript(text) {
  const analogue = [];
  const bytes = [];
  let endCycle;
  text.split('\n').forEach((line, index) => {
    if (line === '') return;
    const errorOf = (problem) => new Error(`line ${index + 1} of the script ${problem}: ${JSON.stringify(line)}`);
    if (endCycle !== undefined) throw errorOf('comes after the end');
    const [, pin, mv] = /^analogue (1[4-9]) (\d+)$/.exec(line) ?? [];
    if (pin !== undefined) {
      analogue.push({ channel: pin - 14, volts: mv / 1000 });
      return;
    }
    const match = /^(\d+) ([0-9a-f]{2})$|^end (\d+)$/.exec(line);
    if (!match) throw errorOf('is none of `analogue <pin> <mV>`, `<cycle> <hex byte>` and `end <cycle>`');
    if (match[3] !== undefined) {
      endCycle = Number(match[3]);
      return;
    }
    const cycle = Number(match[1]);
    if (cycle < (bytes.at(-1)?.cycle ?? 0)) throw errorOf('is earlier than the previous byte');
    bytes.push({ cycle, byte: parseInt(match[2], 16) });
  });
  if (endCycle === undefined) throw new Error('the script has no `end <cycle>`');
  return { analogue, bytes, endCycle };
}
