/* What the shim needs to know of an ATmega328P at 16 MHz.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CHIP_H
#define CHIP_H

#define CHIP_FREQUENCY 16000000u
#define CHIP_VECTORS 26 /* reset included */

/* I/O registers, as data addresses. */
enum {
	REG_PINB = 0x23, REG_PINC = 0x26, REG_PIND = 0x29,
	REG_TIFR0 = 0x35, REG_TIFR1 = 0x36, REG_TIFR2 = 0x37,
	REG_EIMSK = 0x3d, REG_GPIOR0 = 0x3e,
	REG_PCICR = 0x68,
	REG_TIMSK0 = 0x6e, REG_TIMSK1 = 0x6f, REG_TIMSK2 = 0x70,
	REG_TCNT1L = 0x84, REG_ICR1L = 0x86, REG_OCR1AL = 0x88, REG_OCR1BL = 0x8a,
	REG_UCSR0A = 0xc0, REG_UCSR0B = 0xc1, REG_UCSR0C = 0xc2,
	REG_UBRR0L = 0xc4, REG_UBRR0H = 0xc5, REG_UDR0 = 0xc6,
};

#endif
