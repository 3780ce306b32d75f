/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "restart.h"

/* Records every pin as low, and stops Timer0, Timer1 and Timer2, which would continue after simavr's
 * reset. */
static void release_pins_and_stop_timers(struct uno *uno)
{
	static const uint16_t timer_control_registers[] = {
		REG_TCCR0B, REG_TCCR1B, REG_TCCR2B, REG_TCCR0A, REG_TCCR1A, REG_TCCR2A,
	};
	recorder_release_pins(&uno->recorder);
	for (size_t i = 0; i < ARRAY_SIZE(timer_control_registers); i++)
		chip_store(uno->avr, timer_control_registers[i], 0);
}

void restart(struct uno *uno, uint8_t causes)
{
	uno->reset.requested_causes &= RESET_POWER_CUT; /* a requested power cut still follows */
	release_pins_and_stop_timers(uno);
	if (causes & RESET_POWER_ON)
		reset_fill_sram(&uno->reset);
	if (causes & RESET_WATCHDOG)
		uno->watchdog_reset_count++;
	/* Must precede avr_reset, in which watchdog_reset reads WDRF. */
	reset_record(&uno->reset, causes, uno->avr->cycle);
	avr_reset(uno->avr);
	uno->avr->data[REG_MCUSR] = uno->reset.mcusr;
}

bool restart_if_requested(struct uno *uno)
{
	uint8_t causes = uno->reset.requested_causes;
	if (causes & RESET_POWER_CUT)
		restart_cut_power(uno);
	else if (causes)
		restart(uno, causes);
	return causes != 0;
}

void restart_advance_in_reset(struct uno *uno, uint64_t until)
{
	avr_t *avr = uno->avr;
	uint64_t cycles_to_timer = avr_cycle_timer_process(avr);
	if (uno->reset.requested_causes) /* one of the timers has requested a reset */
		return;
	uint64_t cycles_to_end = until - avr->cycle;
	avr->cycle += cycles_to_timer < cycles_to_end ? cycles_to_timer : cycles_to_end;
}

void restart_cut_power(struct uno *uno)
{
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
