// The EEPROM's interrupt comes as long as no byte is being written (data sheet, EECR). avr8js goes on
// calling the handler after it has begun to write one, and takes no byte from it then.
const EEPE = 0x02;

export function eepromReady({ cpu, eeprom }) {
  const { EECR } = eeprom.config;
  const write = cpu.writeHooks[EECR];
  cpu.writeHooks[EECR] = (...args) => {
    const done = write(...args);
    if (cpu.data[EECR] & EEPE) cpu.clearInterrupt(eeprom.EER, false);
    return done;
  };
}
