/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "restart.h"

static void pins_and_timers_off(struct uno *uno)
{
	recorder_release_pins(&uno->recorder);
	reset_stop_timers(&uno->reset);
}

void restart(struct uno *uno, uint8_t cause)
{
	uno->reset.asked = 0;
	pins_and_timers_off(uno);
	if (cause & RESET_POWER_ON)
		reset_fill_sram(&uno->reset);
	if (cause & RESET_WATCHDOG)
		uno->resets++;
	/* First, since the watchdog's own reset reads WDRF. */
	reset_note(&uno->reset, cause, uno->avr->cycle);
	avr_reset(uno->avr);
	reset_show(&uno->reset);
}

bool restart_if_asked(struct uno *uno)
{
	if (uno->reset.cut_asked) {
		restart_cut_power(uno);
		return true;
	}
	if (!uno->reset.asked)
		return false;
	restart(uno, uno->reset.asked);
	return true;
}

bool restart_wait(struct uno *uno, uint64_t until)
{
	avr_t *avr = uno->avr;
	uint64_t next = avr_cycle_timer_process(avr);
	if (uno->reset.asked || uno->reset.cut_asked)
		return true;
	uint64_t left = until - avr->cycle;
	avr->cycle += next < left ? next : left;
	return true;
}

void restart_by_stock_watchdog(struct uno *uno, avr_run_t normal)
{
	pins_and_timers_off(uno);
	uno->resets++;
	reset_note(&uno->reset, RESET_WATCHDOG, uno->avr->cycle);
	uno->avr->run(uno->avr);
	uno->avr->run = normal;
	reset_show(&uno->reset);
}

void restart_cut_power(struct uno *uno)
{
	uno->reset.cut_asked = false;
	uno->reset.asked = 0;
	uno->off = true;
	eeprom_tear(&uno->eeprom);
	pins_and_timers_off(uno);
}

void restart_catch_up(struct uno *uno)
{
	avr_t *avr = uno->avr;
	if (uno->now <= avr->cycle)
		return;
	uno->asleep += uno->now - avr->cycle;
	avr->cycle = uno->now;
}
