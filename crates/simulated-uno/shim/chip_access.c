/* The part of uno.h that concerns EEPROM, supply, ADC, contacts, resets, boot loader and flash.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "board.h"
#include "restart.h"

void uno_reset(struct uno *uno)
{
	restart_catch_up(uno);
	if (!uno->is_powered_off && !uno->supply.holds_reset)
		restart(uno, RESET_EXTERNAL);
}

void uno_power_cycle(struct uno *uno)
{
	restart_catch_up(uno);
	if (!uno->is_powered_off)
		restart_cut_power(uno);
	uno->is_powered_off = false;
	supply_update_reset(&uno->supply);
	restart(uno, uno->supply.holds_reset ? RESET_HOLD : RESET_POWER_ON);
}

void uno_set_boot_loader(struct uno *uno, bool is_present)
{
	uno->reset.has_boot_loader = is_present;
	if (uno->avr->cycle == 0) { /* not started yet: affects the current start, too */
		uno->reset.mcusr = RESET_POWER_ON;
		restart(uno, 0);
	}
}

void uno_set_noise_seed(struct uno *uno, uint64_t seed)
{
	uno->reset.noise_state = seed * 2 + 1; /* odd, because zero would stay zero */
}

bool uno_is_held_in_reset(const struct uno *uno) { return uno->supply.holds_reset; }
struct list *uno_reset_events(struct uno *uno) { return &uno->reset.events; }
uint8_t *uno_eeprom(struct uno *uno) { return uno->eeprom.stock->eeprom; }
struct list *uno_eeprom_operations(struct uno *uno) { return &uno->eeprom.operations; }
void uno_set_torn_bits(struct uno *uno, uint8_t ones) { uno->eeprom.torn_bits = ones; }

void uno_cut_power_at(struct uno *uno, uint64_t cycle)
{
	restart_catch_up(uno);
	supply_schedule_power_cut(&uno->supply, cycle);
}

void uno_cut_power_in_operation(struct uno *uno, uint64_t skip_count, bool in_write)
{
	uno->eeprom.cut_request = (struct eeprom_cut_request){ true, skip_count, in_write };
}

void uno_cancel_power_cut(struct uno *uno)
{
	supply_schedule_power_cut(&uno->supply, 0);
	eeprom_cancel_cut(&uno->eeprom);
}

double uno_supply_mv(const struct uno *uno)
{
	return supply_mv(&uno->supply, uno->now);
}

void uno_ramp_supply(struct uno *uno, double mv, uint64_t cycles)
{
	restart_catch_up(uno);
	supply_ramp(&uno->supply, mv, cycles);
}

void uno_set_brown_out(struct uno *uno, double mv)
{
	restart_catch_up(uno);
	supply_set_brown_out(&uno->supply, mv);
}

void uno_set_bandgap(struct uno *uno, double mv) { uno->adc.bandgap_mv = mv; }

void uno_set_analog(struct uno *uno, uint8_t channel, uint16_t mv)
{
	adc_set_pin_mv(&uno->adc, channel, mv);
}

void uno_set_contact(struct uno *uno, uint8_t number, bool is_closed)
{
	contacts_set(&uno->contacts, number, is_closed);
}

void uno_set_boot_address(struct uno *uno, uint32_t address)
{
	uno->avr->codeend = uno->avr->flashend; /* the boot loader may write code anywhere */
	uno->avr->reset_pc = address;
	uno->avr->pc = address;
}

uint8_t *uno_flash(struct uno *uno) { return uno->avr->flash; }
