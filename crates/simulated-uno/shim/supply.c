/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "supply.h"

#define NOMINAL 5000.0
#define BROWN_OUT 2700.0      /* VBOT of the UNO's fuses, BODLEVEL = 101 (29.5) */
#define HYSTERESIS 50.0       /* VHYST */
#define POWER_ON_RISING 1400.0  /* VPOT, typical */
#define POWER_ON_FALLING 1300.0
#define LEAST_OPERATING 1800.0  /* below it an EEPROM operation is not completed */

double supply_mv(const struct supply *supply, uint64_t cycle)
{
	if (cycle >= supply->end)
		return supply->to;
	double done = (double)(cycle - supply->start) / (double)(supply->end - supply->start);
	return supply->from + (supply->to - supply->from) * done;
}

/* "VBOT- = VBOT - VHYST/2" (11.5) */
static double hold_below(const struct supply *supply)
{
	return supply->brown_out > 0 ? supply->brown_out - HYSTERESIS / 2 : POWER_ON_FALLING;
}

static double release_above(const struct supply *supply)
{
	return supply->brown_out > 0 ? supply->brown_out + HYSTERESIS / 2 : POWER_ON_RISING;
}

/* First cycle after now at which the line is beyond `level`; 0: never. */
static uint64_t crossing(const struct supply *supply, double level)
{
	double slope = supply->to - supply->from;
	double part = (level - supply->from) / slope;
	if (!(part >= 0 && part < 1))
		return 0;
	uint64_t cycle = supply->start + (uint64_t)(part * (supply->end - supply->start)) + 1;
	return cycle > supply->avr->cycle ? cycle : 0;
}

static avr_cycle_count_t look(avr_t *avr, avr_cycle_count_t when, void *param);

/* Looks again when the line crosses the next level. */
static void schedule(struct supply *supply)
{
	const double levels[] = {
		hold_below(supply), release_above(supply), LEAST_OPERATING, POWER_ON_FALLING,
	};
	uint64_t next = 0;
	for (size_t i = 0; i < ARRAY_SIZE(levels); i++) {
		uint64_t cycle = crossing(supply, levels[i]);
		if (cycle && (!next || cycle < next))
			next = cycle;
	}
	avr_t *avr = supply->avr;
	avr_cycle_timer_cancel(avr, look, supply);
	if (next && supply->data_sheet)
		avr_cycle_timer_register(avr, next - avr->cycle, look, supply);
}

static void judge(struct supply *supply, double mv)
{
	if (mv < LEAST_OPERATING)
		eeprom_tear(supply->eeprom);
	if (mv < POWER_ON_FALLING)
		supply->lost = true;
	if (!supply->held && mv < hold_below(supply)) {
		supply->held = true;
		reset_ask(supply->reset, RESET_HOLD);
	} else if (supply->held && mv > release_above(supply)) {
		supply->held = false;
		reset_ask(supply->reset, supply->lost ? RESET_POWER_ON : RESET_BROWN_OUT);
		supply->lost = false;
	}
}

static avr_cycle_count_t look(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct supply *supply = param;
	judge(supply, supply_mv(supply, avr->cycle));
	schedule(supply);
	return 0;
}

static avr_cycle_count_t cut(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct supply *supply = param;
	supply->cut_at = 0;
	reset_ask_power_cut(supply->reset);
	return 0;
}

void supply_attach(struct supply *supply, avr_t *avr, struct reset *reset,
                   struct eeprom *eeprom, bool data_sheet)
{
	*supply = (struct supply){
		.avr = avr,
		.reset = reset,
		.eeprom = eeprom,
		.from = NOMINAL,
		.to = NOMINAL,
		.brown_out = data_sheet ? BROWN_OUT : 0,
		.data_sheet = data_sheet,
	};
}

void supply_ramp(struct supply *supply, double mv, uint64_t now, uint64_t cycles)
{
	avr_t *avr = supply->avr;
	supply->from = supply_mv(supply, now);
	supply->to = mv;
	supply->start = now;
	supply->end = now + cycles;
	avr->vcc = avr->avcc = avr->aref = mv; /* what stock simavr's ADC looks at */
	if (!supply->data_sheet)
		return;
	judge(supply, supply_mv(supply, now));
	schedule(supply);
}

void supply_set_brown_out(struct supply *supply, double mv, uint64_t now)
{
	if (!supply->data_sheet)
		return;
	supply->brown_out = mv;
	judge(supply, supply_mv(supply, now));
	schedule(supply);
}

static void arm_cut(struct supply *supply)
{
	avr_t *avr = supply->avr;
	avr_cycle_timer_cancel(avr, cut, supply);
	if (supply->cut_at)
		avr_cycle_timer_register(avr, chip_cycles_until(avr, supply->cut_at), cut, supply);
}

void supply_cut_at(struct supply *supply, uint64_t cycle)
{
	supply->cut_at = cycle;
	arm_cut(supply);
}

bool supply_may_reset(const struct supply *supply)
{
	return supply->cut_at || supply->avr->cycle < supply->end;
}

void supply_reset(struct supply *supply)
{
	schedule(supply);
	arm_cut(supply);
}

void supply_power_on(struct supply *supply)
{
	supply->held = supply->lost = false;
	double mv = supply_mv(supply, supply->avr->cycle);
	if (supply->data_sheet && mv < release_above(supply))
		supply->held = supply->lost = true;
}
