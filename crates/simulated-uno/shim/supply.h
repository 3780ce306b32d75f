/* The supply voltage, VCC and AVCC in one as on a UNO, and the resets by it: brown-out
 * (data sheet 11.5) and power-on (11.3).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "eeprom.h"
#include "reset.h"

struct supply {
	avr_t *avr;
	struct reset *reset;
	struct eeprom *eeprom;
	double from, to;         /* mV, a straight line from `start` to `end` */
	uint64_t start, end;
	double brown_out;        /* mV, 0: the fuse is off */
	bool data_sheet;
	bool held;               /* the supply holds the chip in reset */
	bool lost;               /* the supply has been too low for the SRAM */
	uint64_t cut_at;         /* cycle at which the power is cut, 0: never */
};

void supply_attach(struct supply *supply, avr_t *avr, struct reset *reset,
                   struct eeprom *eeprom, bool data_sheet);
double supply_mv(const struct supply *supply, uint64_t cycle);
/* A straight line from now on, `cycles` long. */
void supply_ramp(struct supply *supply, double mv, uint64_t now, uint64_t cycles);
void supply_set_brown_out(struct supply *supply, double mv, uint64_t now);
void supply_cut_at(struct supply *supply, uint64_t cycle);
/* True while a ramp of the supply or a power cut can still reset the chip. */
bool supply_may_reset(const struct supply *supply);
/* simavr's reset drops its timers. */
void supply_reset(struct supply *supply);
/* The power is restored after a cut: sets `held` by the present voltage. */
void supply_power_on(struct supply *supply);
