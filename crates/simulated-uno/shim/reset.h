/* Resets by the ATmega328P's data sheet, chapter 11: what is asked for, and the
 * causes in MCUSR.
 *
 * A part that wants a reset, or a power cut, asks here; restart.c carries it
 * out between two instructions. simavr 1.6 knows the watchdog's reset alone and
 * forgets all other causes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "list.h"

/* Bits of MCUSR. */
enum reset_cause {
	RESET_POWER_ON = 1 << 0, RESET_EXTERNAL = 1 << 1, RESET_BROWN_OUT = 1 << 2,
	RESET_WATCHDOG = 1 << 3,
	RESET_HOLD = 1 << 7, /* no cause: the supply is too low, the reset lasts */
};

struct reset_event { uint64_t cycle; uint8_t cause; };

struct reset {
	avr_t *avr;
	bool data_sheet;
	bool boot_loader;      /* one that has cleared MCUSR when the firmware starts */
	uint8_t asked;         /* causes of the reset that is due, 0: none */
	bool cut_asked;        /* a power cut is due */
	uint8_t flags;         /* MCUSR, which simavr forgets */
	uint64_t noise;        /* state of the generator that fills the SRAM */
	uint8_t *sram;         /* the SRAM as power-on left it */
	struct list events;    /* struct reset_event, power-on too */
};

void reset_attach(struct reset *reset, avr_t *avr, bool data_sheet);
void reset_ask(struct reset *reset, enum reset_cause cause);
void reset_ask_power_cut(struct reset *reset);
/* Stops simavr's timers, which would run on through its reset. */
void reset_stop_timers(const struct reset *reset);
/* Adds a cause to those up to now. */
void reset_note(struct reset *reset, uint8_t cause, uint64_t now);
/* MCUSR, which simavr's reset clears. */
void reset_show(const struct reset *reset);
/* Registers r0 to r31 and SRAM hold noise after power-on. */
void reset_fill_sram(struct reset *reset);
/* First SRAM address from `from` on that no longer holds its noise. */
uint16_t reset_first_used(const struct reset *reset, uint16_t from);
void reset_free(struct reset *reset);
