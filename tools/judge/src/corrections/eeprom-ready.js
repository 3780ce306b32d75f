// The EEPROM interrupt is pending only while no write is in progress (data sheet, EECR). avr8js also calls the handler
// during a write, and then ignores the byte that the handler writes.
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
