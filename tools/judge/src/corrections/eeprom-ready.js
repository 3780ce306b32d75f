// The EEPROM's interrupt is pending as long as no byte is being written (data sheet, EECR). avr8js continues
// to call the handler while a byte is being written, and then ignores the handler's byte.
const EEPE = 0x02;

export function holdEepromInterrupt({ cpu, eeprom }) {
  const { EECR } = eeprom.config;
  const writeRegister = cpu.writeHooks[EECR];
  cpu.writeHooks[EECR] = (...args) => {
    const isHandled = writeRegister(...args);
    if (cpu.data[EECR] & EEPE) cpu.clearInterrupt(eeprom.EER, false);
    return isHandled;
  };
}
