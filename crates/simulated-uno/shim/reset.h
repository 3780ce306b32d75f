/* Resets according to the ATmega328P's data sheet, chapter 11: pending requests, the causes in MCUSR,
 * and the SRAM at power-on.
 *
 * A part requests a reset or a power cut here; restart.c executes the request between two
 * instructions. simavr 1.6 has only the watchdog's reset, and its MCUSR keeps only the last cause.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "list.h"

/* Bits of MCUSR. Must match `ResetCause` in src/reset.rs. */
enum reset_cause {
	RESET_POWER_ON = 1 << 0, RESET_EXTERNAL = 1 << 1, RESET_BROWN_OUT = 1 << 2,
	RESET_WATCHDOG = 1 << 3,
	/* Not in MCUSR: */
	RESET_POWER_CUT = 1 << 6, /* the power is cut */
	RESET_HOLD = 1 << 7, /* the supply is too low and holds the chip in reset */
};

struct reset_event { uint64_t cycle; uint8_t cause; };

struct reset {
	avr_t *avr;
	bool follows_data_sheet;
	bool has_boot_loader;     /* a boot loader clears MCUSR before the firmware starts */
	uint8_t requested_causes; /* causes of the requested reset or power cut; 0 if none */
	uint8_t mcusr;            /* MCUSR, which simavr's reset clears */
	uint64_t noise_state;     /* state of the random generator whose output fills the SRAM */
	uint8_t initial_sram[CHIP_SRAM_END]; /* the data space right after power-on */
	struct list events;       /* all resets, including power-on: struct reset_event */
};

void reset_attach(struct reset *reset, avr_t *avr, bool follows_data_sheet);
void reset_request(struct reset *reset, enum reset_cause cause);
/* Records a reset, and adds its causes to `mcusr`. */
void reset_record(struct reset *reset, uint8_t causes, uint64_t now);
/* Fills r0 to r31 and the SRAM with noise, as power-on does. */
void reset_fill_sram(struct reset *reset);
