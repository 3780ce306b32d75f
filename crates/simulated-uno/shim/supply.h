/* The supply voltage, for both VCC and AVCC as on a UNO, and the resets that it causes:
 * brown-out (data sheet 11.5) and power-on (11.3).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "eeprom.h"
#include "reset.h"

struct supply {
	struct reset *reset;
	struct eeprom *eeprom;
	double from_mv;          /* voltage until cycle `ramp_start` */
	double to_mv;            /* voltage from cycle `ramp_end` on; in between, it changes linearly */
	uint64_t ramp_start, ramp_end;
	double brown_out_mv;     /* brown-out level; 0: brown-out detection is off */
	bool holds_reset;        /* the supply is too low and holds the chip in reset */
	bool has_lost_sram;      /* the supply has been too low for the SRAM to keep its contents */
	uint64_t power_cut_at;   /* cycle at which the power is cut; 0: never */
};

void supply_attach(struct supply *supply, struct reset *reset, struct eeprom *eeprom);
/* The voltage at a cycle, which must not be before the start of the last ramp. */
double supply_mv(const struct supply *supply, uint64_t cycle);
/* Changes the voltage linearly to `mv` over `cycles` from now. */
void supply_ramp(struct supply *supply, double mv, uint64_t cycles);
/* Sets the brown-out level; 0 switches brown-out detection off. */
void supply_set_brown_out(struct supply *supply, double mv);
/* Schedules a power cut at a cycle; 0: never. */
void supply_schedule_power_cut(struct supply *supply, uint64_t cycle);
/* True while a ramp of the supply or a power cut can still reset the chip. */
bool supply_may_reset(const struct supply *supply);
/* Arms the timers of the supply again; must be called after simavr's reset, which drops all timers. */
void supply_rearm_timers(struct supply *supply);
/* Sets `holds_reset` according to the current voltage; must be called when the power is restored
 * after a cut. */
void supply_update_reset(struct supply *supply);
