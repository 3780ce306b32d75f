/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "eeprom.h"

enum { /* EECR */
	EEPM = 3 << 4, EERIE = 1 << 3, EEMPE = 1 << 2, EEPE = 1 << 1, EERE = 1 << 0,
};

#define ARMED_CYCLES 4 /* after EEMPE is set, EEPE must be set within this time */
#define READ_HALT_CYCLES 4 /* the CPU is halted after EERE is set */
#define WRITE_HALT_CYCLES 2 /* the CPU is halted after EEPE is set */

/* Durations of an operation, indexed by enum eeprom_mode (table 8-1). */
static const uint64_t duration_cycles[] = {
	3400 * CHIP_CYCLES_PER_US, 1800 * CHIP_CYCLES_PER_US, 1800 * CHIP_CYCLES_PER_US,
};

static struct eeprom_operation *latest_operation(const struct eeprom *eeprom)
{
	struct eeprom_operation *operations = eeprom->operations.items;
	return &operations[eeprom->operations.count - 1];
}

static uint16_t selected_address(const avr_t *avr)
{
	return avr->data[REG_EEARL] | (avr->data[REG_EEARH] & 0x03) << 8;
}

static avr_cycle_count_t finish_operation(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct eeprom *eeprom = param;
	const struct eeprom_operation *operation = latest_operation(eeprom);
	eeprom->stock->eeprom[operation->address] = operation->new_value;
	eeprom->is_busy = false;
	avr_raise_interrupt(avr, &eeprom->stock->ready); /* wakes the CPU, if enabled */
	return 0;
}

static avr_cycle_count_t cut_power(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct eeprom *eeprom = param;
	reset_request(eeprom->reset, RESET_POWER_CUT);
	return 0;
}

/* The cycle at which this number of quarters of the latest operation is over. An erase-and-write
 * operation erases until a cycle that the data sheet does not specify; half of the duration is
 * assumed. */
static uint64_t end_of_quarters(const struct eeprom *eeprom, unsigned quarters)
{
	const struct eeprom_operation *operation = latest_operation(eeprom);
	return operation->cycle + duration_cycles[operation->mode] * quarters / 4;
}

static void arm_timers(struct eeprom *eeprom)
{
	avr_t *avr = eeprom->avr;
	chip_call_at(avr, end_of_quarters(eeprom, 4), finish_operation, eeprom);
	if (eeprom->cut_at)
		chip_call_at(avr, eeprom->cut_at, cut_power, eeprom);
}

/* Counts this operation for the requested power cut. Returns the cycle of the cut, in the middle of
 * the requested phase, or 0 if the cut is not in this operation. */
static uint64_t take_cut_request(struct eeprom *eeprom, uint8_t mode)
{
	struct eeprom_cut_request *request = &eeprom->cut_request;
	if (!request->is_pending)
		return 0;
	if (request->skip_count) {
		request->skip_count--;
		return 0;
	}
	request->is_pending = false;
	if (mode != EEPROM_ERASE_WRITE)
		return end_of_quarters(eeprom, 2);
	return end_of_quarters(eeprom, request->in_write ? 3 : 1);
}

static void begin_operation(struct eeprom *eeprom, uint64_t cycle)
{
	avr_t *avr = eeprom->avr;
	uint8_t mode = (avr->data[REG_EECR] & EEPM) >> 4;
	if (mode > EEPROM_WRITE)
		mode = EEPROM_ERASE_WRITE; /* reserved value; assumed */
	uint16_t address = selected_address(avr);
	uint8_t old_value = eeprom->stock->eeprom[address];
	uint8_t data = avr->data[REG_EEDR];
	uint8_t new_value = mode == EEPROM_ERASE ? 0xff : mode == EEPROM_WRITE ? old_value & data : data;
	const struct eeprom_operation operation = { cycle, address, mode, old_value, new_value, false };
	list_push(&eeprom->operations, &operation);
	eeprom->is_busy = true;
	eeprom->written_data = data;
	eeprom->cut_at = take_cut_request(eeprom, mode);
	avr->cycle += WRITE_HALT_CYCLES;
	arm_timers(eeprom);
}

static void write_control(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct eeprom *eeprom = param;
	const struct instruction *instruction = eeprom->interrupts->instruction;
	uint64_t cycle = instruction_store_cycle(instruction);
	uint8_t touched = instruction_touched_bits(instruction);
	uint8_t ones = value & touched;
	bool is_armed = cycle <= eeprom->armed_until;
	uint8_t stored_bits = touched & (EERIE | (eeprom->is_busy ? 0 : EEPM));
	uint8_t kept_bits = avr->data[address] & (EERIE | EEPM) & ~stored_bits;
	avr->data[address] = kept_bits | (value & stored_bits);
	/* Also ends the slice of instructions that simavr runs at once: simavr does not count the
	 * cycles of a halt in the slice, so timers would be late. */
	interrupts_request_check(eeprom->interrupts);
	if (eeprom->is_busy)
		ones &= EEMPE;
	if ((ones & EEMPE) && !(value & touched & EEPE))
		eeprom->armed_until = cycle + ARMED_CYCLES;
	if ((ones & EEPE) && is_armed) {
		begin_operation(eeprom, cycle);
	} else if (ones & EERE) {
		avr->data[REG_EEDR] = eeprom->stock->eeprom[selected_address(avr)];
		avr->cycle += READ_HALT_CYCLES;
	}
}

static uint8_t read_control(avr_t *avr, avr_io_addr_t address, void *param)
{
	const struct eeprom *eeprom = param;
	uint8_t value = avr->data[address] & (EERIE | EEPM);
	if (eeprom->is_busy)
		value |= EEPE;
	if (avr->cycle < eeprom->armed_until)
		value |= EEMPE;
	return value;
}

/* "If a write operation is in progress, it is neither possible to read the
 * EEPROM, nor to change the EEAR Register" (8.6.3). */
static void write_address(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	const struct eeprom *eeprom = param;
	if (!eeprom->is_busy)
		avr->data[address] = address == REG_EEARH ? value & 0x03 : value;
}

void eeprom_attach(struct eeprom *eeprom, avr_t *avr)
{
	*eeprom = (struct eeprom){
		.avr = avr,
		.stock = (avr_eeprom_t *)chip_find_peripheral(avr, "eeprom"),
		.operations.item_size = sizeof(struct eeprom_operation),
	};
}

void eeprom_correct(struct eeprom *eeprom, struct interrupts *interrupts, struct reset *reset)
{
	avr_t *avr = eeprom->avr;
	eeprom->interrupts = interrupts;
	eeprom->reset = reset;
	interrupts->eeprom_ready = &eeprom->stock->ready;
	interrupts->is_eeprom_busy = &eeprom->is_busy;
	hook_read_and_write(avr, REG_EECR, read_control, write_control, eeprom);
	hook_write(avr, REG_EEARL, write_address, eeprom);
	hook_write(avr, REG_EEARH, write_address, eeprom);
}

void eeprom_reset(struct eeprom *eeprom)
{
	avr_t *avr = eeprom->avr;
	eeprom->armed_until = 0;
	if (!eeprom->is_busy)
		return;
	/* "During reset, the EEPMn bits will be reset to 0b00 unless the EEPROM
	 * is busy programming" (8.6.3). */
	avr->data[REG_EECR] = latest_operation(eeprom)->mode << 4;
	arm_timers(eeprom);
}

void eeprom_tear(struct eeprom *eeprom)
{
	if (!eeprom->is_busy)
		return;
	avr_t *avr = eeprom->avr;
	struct eeprom_operation *operation = latest_operation(eeprom);
	uint8_t ones = eeprom->torn_bits;
	bool is_first_half = avr->cycle < end_of_quarters(eeprom, 2);
	if (operation->mode == EEPROM_ERASE || (operation->mode == EEPROM_ERASE_WRITE && is_first_half))
		operation->new_value = operation->old_value | ones;
	else if (operation->mode == EEPROM_WRITE)
		operation->new_value = operation->old_value & (eeprom->written_data | ones);
	else
		operation->new_value = eeprom->written_data | ones;
	operation->is_torn = true;
	eeprom->stock->eeprom[operation->address] = operation->new_value;
	avr_cycle_timer_cancel(avr, finish_operation, eeprom);
	avr_cycle_timer_cancel(avr, cut_power, eeprom);
	eeprom->is_busy = false;
}

void eeprom_cancel_cut(struct eeprom *eeprom)
{
	eeprom->cut_request.is_pending = false;
	eeprom->cut_at = 0;
	avr_cycle_timer_cancel(eeprom->avr, cut_power, eeprom);
}
