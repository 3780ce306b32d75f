/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "restart.h"

static void release_pins_and_stop_timers(struct uno *uno)
{
	recorder_release_pins(&uno->recorder);
	reset_stop_timers(&uno->reset);
}

void restart(struct uno *uno, uint8_t causes)
{
	uno->reset.requested_causes = 0;
	release_pins_and_stop_timers(uno);
	if (causes & RESET_POWER_ON)
		reset_fill_sram(&uno->reset);
	if (causes & RESET_WATCHDOG)
		uno->watchdog_resets++;
	/* Before avr_reset, because watchdog_reset reads WDRF. */
	reset_record(&uno->reset, causes, uno->avr->cycle);
	avr_reset(uno->avr);
	reset_restore_mcusr(&uno->reset);
}

bool restart_if_requested(struct uno *uno)
{
	if (uno->reset.is_power_cut_requested) {
		restart_cut_power(uno);
		return true;
	}
	if (!uno->reset.requested_causes)
		return false;
	restart(uno, uno->reset.requested_causes);
	return true;
}

void restart_advance_in_reset(struct uno *uno, uint64_t until)
{
	avr_t *avr = uno->avr;
	uint64_t cycles_to_timer = avr_cycle_timer_process(avr);
	if (uno->reset.requested_causes || uno->reset.is_power_cut_requested)
		return;
	uint64_t cycles_to_end = until - avr->cycle;
	avr->cycle += cycles_to_timer < cycles_to_end ? cycles_to_timer : cycles_to_end;
}

void restart_by_stock_watchdog(struct uno *uno, avr_run_t normal_run)
{
	release_pins_and_stop_timers(uno);
	uno->watchdog_resets++;
	reset_record(&uno->reset, RESET_WATCHDOG, uno->avr->cycle);
	uno->avr->run(uno->avr);
	uno->avr->run = normal_run;
	reset_restore_mcusr(&uno->reset);
}

void restart_cut_power(struct uno *uno)
{
	uno->reset.is_power_cut_requested = false;
	uno->reset.requested_causes = 0;
	uno->is_powered_off = true;
	eeprom_tear(&uno->eeprom);
	release_pins_and_stop_timers(uno);
}

void restart_catch_up(struct uno *uno)
{
	avr_t *avr = uno->avr;
	if (uno->now <= avr->cycle)
		return;
	uno->sleep_cycles += uno->now - avr->cycle;
	avr->cycle = uno->now;
}
