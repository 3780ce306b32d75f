/* EEPROM, supply, ADC, contacts, resets, boot loader and flash, as src/ uses them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "board.h"
#include "restart.h"

void uno_reset(struct uno *uno)
{
	restart_catch_up(uno);
	if (!uno->off && !uno->supply.held)
		restart(uno, RESET_EXTERNAL);
}

void uno_power_cycle(struct uno *uno)
{
	restart_catch_up(uno);
	if (!uno->off)
		restart_cut_power(uno);
	uno->off = false;
	supply_power_on(&uno->supply);
	restart(uno, uno->supply.held ? RESET_HOLD : RESET_POWER_ON);
}

void uno_set_boot_loader(struct uno *uno, bool on)
{
	uno->reset.boot_loader = on;
	if (uno->avr->cycle == 0) { /* this start, too */
		uno->reset.flags = RESET_POWER_ON;
		restart(uno, 0);
	}
}

void uno_set_noise(struct uno *uno, uint64_t seed)
{
	uno->reset.noise = seed * 2 + 1; /* the generator stands still at zero */
}

bool uno_held_in_reset(const struct uno *uno) { return uno->supply.held; }
struct list *uno_reset_events(struct uno *uno) { return &uno->reset.events; }
uint8_t *uno_eeprom(struct uno *uno) { return uno->eeprom.stock->eeprom; }
struct list *uno_eeprom_operations(struct uno *uno) { return &uno->eeprom.operations; }
void uno_set_torn_ones(struct uno *uno, uint8_t ones) { uno->eeprom.torn_ones = ones; }

void uno_cut_power_at(struct uno *uno, uint64_t cycle)
{
	restart_catch_up(uno);
	supply_cut_at(&uno->supply, cycle);
}

void uno_cut_power_in_operation(struct uno *uno, uint64_t skip, bool in_write)
{
	uno->eeprom.ask = (struct eeprom_cut){ true, skip, in_write };
}

void uno_keep_power(struct uno *uno)
{
	supply_cut_at(&uno->supply, 0);
	eeprom_keep_power(&uno->eeprom);
}

double uno_supply(const struct uno *uno)
{
	return supply_mv(&uno->supply, uno->now);
}

void uno_ramp_supply(struct uno *uno, double mv, uint64_t cycles)
{
	restart_catch_up(uno);
	supply_ramp(&uno->supply, mv, uno->avr->cycle, cycles);
}

void uno_set_brown_out(struct uno *uno, double mv)
{
	restart_catch_up(uno);
	supply_set_brown_out(&uno->supply, mv, uno->avr->cycle);
}

void uno_set_bandgap(struct uno *uno, double mv) { uno->adc.bandgap = mv; }

void uno_set_analog(struct uno *uno, uint8_t channel, uint16_t mv)
{
	adc_set_pin(&uno->adc, channel, mv);
}

void uno_set_contact(struct uno *uno, uint16_t address, uint8_t bit, bool closed)
{
	contacts_set(&uno->contacts, address, bit, closed);
}

void uno_boot_at(struct uno *uno, uint32_t address)
{
	uno->avr->codeend = uno->avr->flashend; /* more code may come */
	uno->avr->reset_pc = address;
	uno->avr->pc = address;
}

uint8_t *uno_flash(struct uno *uno) { return uno->avr->flash; }
