/* An ATmega328P at 16 MHz: its registers, and hooks for our own callbacks in simavr's callback
 * table.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <simavr/sim_avr.h>
#include <simavr/sim_io.h>

#define CHIP_FREQUENCY 16000000u /* Hz */
#define CHIP_CYCLES_PER_US (CHIP_FREQUENCY / 1000000u)
#define CHIP_IO_START 0x20u /* first data address after r0 to r31 */
#define CHIP_SRAM_START 0x100u /* first data address after the registers */
#define CHIP_SRAM_END 0x900u /* first data address after the SRAM */
#define CHIP_VECTOR_COUNT 26 /* interrupt vectors, including reset */

/* Arduino's pin numbers: 0 to 7 are D0 to D7 (port D), 8 to 13 are D8 to D13 (port B), 14 to 19 are
 * A0 to A5 (port C). */
#define CHIP_PIN_COUNT 20

/* The ports B, C and D, with index 0 to 2. Each has a PIN, a DDR and a PORT register, one after
 * another. */
#define CHIP_PORT_COUNT 3
#define CHIP_PIN_REGISTER(port) (REG_PINB + 3 * (port))
#define CHIP_PORT_INDEX(pin_register) (((pin_register) - REG_PINB) / 3)

/* I/O registers, as data addresses. */
enum {
	REG_PINB = 0x23,
	REG_TIFR0 = 0x35, REG_TIFR1 = 0x36, REG_TIFR2 = 0x37,
	REG_EIMSK = 0x3d, REG_GPIOR0 = 0x3e,
	REG_EECR = 0x3f, REG_EEDR = 0x40, REG_EEARL = 0x41, REG_EEARH = 0x42,
	REG_TCCR0A = 0x44, REG_TCCR0B = 0x45,
	REG_MCUSR = 0x54, REG_WDTCSR = 0x60,
	REG_PCICR = 0x68,
	REG_TIMSK0 = 0x6e, REG_TIMSK1 = 0x6f, REG_TIMSK2 = 0x70,
	REG_ADCL = 0x78, REG_ADCH = 0x79, REG_ADCSRA = 0x7a, REG_ADMUX = 0x7c,
	REG_TCCR1A = 0x80, REG_TCCR1B = 0x81, REG_TCCR2A = 0xb0, REG_TCCR2B = 0xb1,
	REG_TCNT1L = 0x84, REG_ICR1L = 0x86,
	REG_UCSR0A = 0xc0, REG_UCSR0B = 0xc1, REG_UCSR0C = 0xc2,
	REG_UBRR0L = 0xc4, REG_UBRR0H = 0xc5, REG_UDR0 = 0xc6,
};

/* A pin of the chip: the name of its port, 'B', 'C' or 'D', and its bit in the port's registers. */
struct chip_pin { char port; uint8_t bit; };

/* Returns the pin with this Arduino number. */
struct chip_pin chip_find_pin(uint8_t number);

/* Returns simavr's peripheral of this kind, such as "eeprom". Aborts if this libsimavr has none. */
avr_io_t *chip_find_peripheral(avr_t *avr, const char *kind);

/* Makes simavr call `timer` at `cycle`, but not before the next cycle. */
void chip_call_at(avr_t *avr, uint64_t cycle, avr_cycle_timer_t timer, void *param);

/* Stores to a data address as the instruction `sts` does. Ignores addresses beyond SRAM. */
void chip_store(avr_t *avr, uint16_t address, uint8_t value);

/* A callback for each write or read of an I/O register. hook_write and hook_read can replace an
 * existing callback, unlike simavr's own registration functions. */
struct write_hook { avr_io_write_t callback; void *param; };
struct read_hook { avr_io_read_t callback; void *param; };

/* hook_write and hook_read return the previous callback. `address` is a data address. With
 * `callback` NULL, the register behaves as plain memory. */
struct write_hook hook_write(avr_t *avr, uint16_t address, avr_io_write_t callback, void *param);
struct read_hook hook_read(avr_t *avr, uint16_t address, avr_io_read_t callback, void *param);
/* Replaces both callbacks of a register. */
void hook_read_and_write(avr_t *avr, uint16_t address, avr_io_read_t read, avr_io_write_t write,
                         void *param);
