// The EEPROM's interrupt is pending as long as no byte is being written (data sheet, EECR). avr8js continues
// to call the handler while a byte is being written, and ignores the handler's byte then.
const EEPE = 0x02;

export function eepromReady({ cpu, eeprom }) {
  const { EECR } = eeprom.config;
  const write = cpu.writeHooks[EECR];
  cpu.writeHooks[EECR] = (...args) => {
    const isWritten = write(...args);
    if (cpu.data[EECR] & EEPE) cpu.clearInterrupt(eeprom.EER, false);
    return isWritten;
  };
}
