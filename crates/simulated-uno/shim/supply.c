/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "supply.h"

#define NOMINAL_MV 5000.0
#define BROWN_OUT_MV 2700.0        /* VBOT with the UNO's fuses, BODLEVEL = 101 (data sheet 29.5) */
#define HYSTERESIS_MV 50.0         /* VHYST */
#define POWER_ON_RISING_MV 1400.0  /* VPOT, typical: a rising supply releases the power-on reset */
#define POWER_ON_FALLING_MV 1300.0 /* VPOT, typical: a falling supply causes the power-on reset */
#define MIN_OPERATING_MV 1800.0    /* below this, an EEPROM operation ends with a torn byte */

double supply_mv(const struct supply *supply, uint64_t cycle)
{
	if (cycle >= supply->ramp_end)
		return supply->to_mv;
	double ramp_cycles = (double)(supply->ramp_end - supply->ramp_start);
	double elapsed_fraction = (double)(cycle - supply->ramp_start) / ramp_cycles;
	return supply->from_mv + (supply->to_mv - supply->from_mv) * elapsed_fraction;
}

/* The voltage below which the supply holds the chip in reset: "VBOT- = VBOT - VHYST/2"
 * (data sheet 11.5). */
static double hold_below_mv(const struct supply *supply)
{
	return supply->brown_out_mv > 0 ? supply->brown_out_mv - HYSTERESIS_MV / 2 : POWER_ON_FALLING_MV;
}

/* The voltage above which the supply releases the chip: "VBOT+ = VBOT + VHYST/2" (11.5). */
static double release_above_mv(const struct supply *supply)
{
	return supply->brown_out_mv > 0 ? supply->brown_out_mv + HYSTERESIS_MV / 2 : POWER_ON_RISING_MV;
}

/* The first cycle after the current one at which the ramp is beyond `level_mv`, or 0 if none. */
static uint64_t crossing_cycle(const struct supply *supply, double level_mv)
{
	double change_mv = supply->to_mv - supply->from_mv;
	double fraction = (level_mv - supply->from_mv) / change_mv;
	if (!(fraction >= 0 && fraction < 1))
		return 0;
	uint64_t ramp_cycles = supply->ramp_end - supply->ramp_start;
	uint64_t cycle = supply->ramp_start + (uint64_t)(fraction * ramp_cycles) + 1;
	return cycle > supply->reset->avr->cycle ? cycle : 0;
}

static avr_cycle_count_t check_supply(avr_t *avr, avr_cycle_count_t when, void *param);

/* Schedules a check of the supply at the cycle at which the ramp crosses the next level. */
static void schedule_check(struct supply *supply)
{
	const double levels_mv[] = {
		hold_below_mv(supply), release_above_mv(supply), MIN_OPERATING_MV, POWER_ON_FALLING_MV,
	};
	uint64_t next_check = 0;
	for (size_t i = 0; i < ARRAY_SIZE(levels_mv); i++) {
		uint64_t cycle = crossing_cycle(supply, levels_mv[i]);
		if (cycle && (!next_check || cycle < next_check))
			next_check = cycle;
	}
	avr_t *avr = supply->reset->avr;
	avr_cycle_timer_cancel(avr, check_supply, supply);
	if (next_check && supply->reset->follows_data_sheet)
		chip_call_at(avr, next_check, check_supply, supply);
}

/* Applies the current voltage to the reset, the EEPROM and the SRAM. */
static void apply_voltage(struct supply *supply)
{
	if (!supply->reset->follows_data_sheet)
		return;
	double mv = supply_mv(supply, supply->reset->avr->cycle);
	if (mv < MIN_OPERATING_MV)
		eeprom_tear(supply->eeprom);
	if (mv < POWER_ON_FALLING_MV)
		supply->has_lost_sram = true;
	if (!supply->holds_reset && mv < hold_below_mv(supply)) {
		supply->holds_reset = true;
		reset_request(supply->reset, RESET_HOLD);
	} else if (supply->holds_reset && mv > release_above_mv(supply)) {
		supply->holds_reset = false;
		reset_request(supply->reset, supply->has_lost_sram ? RESET_POWER_ON : RESET_BROWN_OUT);
		supply->has_lost_sram = false;
	}
	schedule_check(supply);
}

static avr_cycle_count_t check_supply(avr_t *avr, avr_cycle_count_t when, void *param)
{
	apply_voltage(param);
	return 0;
}

static avr_cycle_count_t cut_power(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct supply *supply = param;
	supply->power_cut_at = 0;
	reset_request(supply->reset, RESET_POWER_CUT);
	return 0;
}

void supply_attach(struct supply *supply, struct reset *reset, struct eeprom *eeprom)
{
	*supply = (struct supply){
		.reset = reset,
		.eeprom = eeprom,
		.from_mv = NOMINAL_MV,
		.to_mv = NOMINAL_MV,
		.brown_out_mv = BROWN_OUT_MV,
	};
}

void supply_ramp(struct supply *supply, double mv, uint64_t cycles)
{
	avr_t *avr = supply->reset->avr;
	supply->from_mv = supply_mv(supply, avr->cycle);
	supply->to_mv = mv;
	supply->ramp_start = avr->cycle;
	supply->ramp_end = avr->cycle + cycles;
	avr->vcc = avr->avcc = avr->aref = mv; /* read by stock simavr's ADC */
	apply_voltage(supply);
}

void supply_set_brown_out(struct supply *supply, double mv)
{
	supply->brown_out_mv = mv;
	apply_voltage(supply);
}

static void schedule_power_cut(struct supply *supply)
{
	avr_t *avr = supply->reset->avr;
	avr_cycle_timer_cancel(avr, cut_power, supply);
	if (supply->power_cut_at)
		chip_call_at(avr, supply->power_cut_at, cut_power, supply);
}

void supply_schedule_power_cut(struct supply *supply, uint64_t cycle)
{
	supply->power_cut_at = cycle;
	schedule_power_cut(supply);
}

bool supply_may_reset(const struct supply *supply)
{
	return supply->power_cut_at || supply->reset->avr->cycle < supply->ramp_end;
}

void supply_rearm_timers(struct supply *supply)
{
	schedule_check(supply);
	schedule_power_cut(supply);
}

void supply_update_reset(struct supply *supply)
{
	double mv = supply_mv(supply, supply->reset->avr->cycle);
	bool is_too_low = supply->reset->follows_data_sheet && mv < release_above_mv(supply);
	supply->holds_reset = supply->has_lost_sram = is_too_low;
}
