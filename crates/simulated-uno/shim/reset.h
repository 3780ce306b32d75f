/* Resets by the ATmega328P's data sheet, chapter 11: pending requests, and the
 * causes in MCUSR.
 *
 * A part requests a reset or a power cut here; restart.c carries it
 * out between two instructions. simavr 1.6 has the watchdog's reset only and
 * forgets all other causes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "list.h"

/* Bits of MCUSR. Kept in step with `ResetCause` in src/reset.rs. */
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
	uint8_t asked;         /* causes of the requested reset, 0: none */
	bool cut_asked;        /* a power cut is requested */
	uint8_t flags;         /* MCUSR, which simavr does not keep */
	uint64_t noise;        /* state of the generator that fills the SRAM */
	uint8_t *sram;         /* the SRAM as power-on left it */
	struct list events;    /* struct reset_event, power-on included */
};

void reset_attach(struct reset *reset, avr_t *avr, bool data_sheet);
void reset_ask(struct reset *reset, enum reset_cause cause);
void reset_ask_power_cut(struct reset *reset);
/* Stops simavr's timers, which would continue after its reset. */
void reset_stop_timers(const struct reset *reset);
/* Adds a cause to the previous ones. */
void reset_note(struct reset *reset, uint8_t cause, uint64_t now);
/* MCUSR, which simavr's reset clears. */
void reset_show(const struct reset *reset);
/* Fills registers r0 to r31 and the SRAM with noise, as at power-on. */
void reset_fill_sram(struct reset *reset);
/* The first SRAM address from `from` on that does not contain its noise any more. */
uint16_t reset_first_used(const struct reset *reset, uint16_t from);
void reset_free(struct reset *reset);
