/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "eeprom.h"

enum { /* EECR */
	EEPM = 3 << 4, EERIE = 1 << 3, EEMPE = 1 << 2, EEPE = 1 << 1, EERE = 1 << 0,
};

#define ARMED_CYCLES 4
#define READ_HALT 4
#define WRITE_HALT 2

/* Table 8-1, by enum eeprom_mode. */
static const uint64_t duration[] = {
	3400 * CHIP_CYCLES_PER_US, 1800 * CHIP_CYCLES_PER_US, 1800 * CHIP_CYCLES_PER_US,
};

static struct eeprom_operation *latest(struct eeprom *eeprom)
{
	struct eeprom_operation *operations = eeprom->operations.items;
	return &operations[eeprom->operations.count - 1];
}

static uint16_t address_of(const avr_t *avr)
{
	return avr->data[REG_EEARL] | (avr->data[REG_EEARH] & 0x03) << 8;
}

static void set_idle(struct eeprom *eeprom)
{
	eeprom->busy = false;
	eeprom->interrupts->eeprom_ready.up = true;
}

static avr_cycle_count_t finish(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct eeprom *eeprom = param;
	const struct eeprom_operation *operation = latest(eeprom);
	eeprom->stock->eeprom[operation->address] = operation->stored;
	set_idle(eeprom);
	avr_raise_interrupt(avr, &eeprom->stock->ready); /* wakes the CPU, if enabled */
	return 0;
}

static avr_cycle_count_t cut_power(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct eeprom *eeprom = param;
	reset_ask_power_cut(eeprom->reset);
	return 0;
}

static void arm_timers(struct eeprom *eeprom)
{
	avr_t *avr = eeprom->avr;
	avr_cycle_timer_register(avr, chip_cycles_until(avr, eeprom->end), finish, eeprom);
	if (eeprom->cut)
		avr_cycle_timer_register(avr, chip_cycles_until(avr, eeprom->cut), cut_power,
		                         eeprom);
}

/* Cycle at which an erase and write has erased: the data sheet does not say, so
 * the middle. */
static uint64_t erased_at(const struct eeprom *eeprom)
{
	return eeprom->start + (eeprom->end - eeprom->start) / 2;
}

/* The middle of the phase in which the power is to fail; 0: not in this
 * operation. */
static uint64_t cut_cycle(struct eeprom *eeprom, uint8_t mode)
{
	struct eeprom_cut *ask = &eeprom->ask;
	if (!ask->on)
		return 0;
	if (ask->skip) {
		ask->skip--;
		return 0;
	}
	ask->on = false;
	uint64_t middle = erased_at(eeprom);
	if (mode == EEPROM_ERASE || mode == EEPROM_WRITE)
		return middle;
	return ask->in_write ? (middle + eeprom->end) / 2 : (eeprom->start + middle) / 2;
}

static void begin(struct eeprom *eeprom, uint64_t cycle)
{
	avr_t *avr = eeprom->avr;
	uint8_t mode = (avr->data[REG_EECR] & EEPM) >> 4;
	if (mode > EEPROM_WRITE)
		mode = EEPROM_ERASE_WRITE; /* reserved */
	uint16_t address = address_of(avr);
	uint8_t old = eeprom->stock->eeprom[address];
	uint8_t data = avr->data[REG_EEDR];
	uint8_t stored = mode == EEPROM_ERASE ? 0xff : mode == EEPROM_WRITE ? old & data : data;
	struct eeprom_operation *operation = list_push(&eeprom->operations);
	*operation = (struct eeprom_operation){ cycle, address, mode, old, stored, false };
	eeprom->busy = true;
	eeprom->interrupts->eeprom_ready.up = false;
	eeprom->target = data;
	eeprom->start = cycle;
	eeprom->end = cycle + duration[mode];
	eeprom->cut = cut_cycle(eeprom, mode);
	instruction_halt_cpu(eeprom->instruction, WRITE_HALT);
	arm_timers(eeprom);
}

static void write_control(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct eeprom *eeprom = param;
	uint64_t cycle = instruction_effect_cycle(eeprom->instruction);
	uint8_t touched = instruction_touched_bits(eeprom->instruction);
	uint8_t ones = value & touched;
	bool armed = cycle <= eeprom->armed_until;
	uint8_t plain = touched & (EERIE | (eeprom->busy ? 0 : EEPM));
	avr->data[address] = (avr->data[address] & (EERIE | EEPM) & ~plain) | (value & plain);
	interrupts_changed(eeprom->interrupts);
	if (eeprom->busy)
		ones &= EEMPE;
	if ((ones & EEMPE) && !(value & touched & EEPE))
		eeprom->armed_until = cycle + ARMED_CYCLES;
	if ((ones & EEPE) && armed) {
		begin(eeprom, cycle);
	} else if (ones & EERE) {
		avr->data[REG_EEDR] = eeprom->stock->eeprom[address_of(avr)];
		instruction_halt_cpu(eeprom->instruction, READ_HALT);
	}
}

static uint8_t read_control(avr_t *avr, avr_io_addr_t address, void *param)
{
	const struct eeprom *eeprom = param;
	uint8_t value = avr->data[address] & (EERIE | EEPM);
	if (eeprom->busy)
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
	if (!eeprom->busy)
		avr->data[address] = address == REG_EEARH ? value & 0x03 : value;
}

void eeprom_attach(struct eeprom *eeprom, avr_t *avr)
{
	*eeprom = (struct eeprom){
		.avr = avr,
		.stock = (avr_eeprom_t *)chip_part(avr, "eeprom"),
		.operations.size = sizeof(struct eeprom_operation),
	};
}

void eeprom_correct(struct eeprom *eeprom, const struct instruction *instruction,
                    struct interrupts *interrupts, struct reset *reset)
{
	avr_t *avr = eeprom->avr;
	eeprom->instruction = instruction;
	eeprom->interrupts = interrupts;
	eeprom->reset = reset;
	interrupts->eeprom_ready = (struct level){ &eeprom->stock->ready, true };
	hook_write(avr, REG_EECR, write_control, eeprom);
	hook_read(avr, REG_EECR, read_control, eeprom);
	hook_write(avr, REG_EEARL, write_address, eeprom);
	hook_write(avr, REG_EEARH, write_address, eeprom);
}

void eeprom_reset(struct eeprom *eeprom)
{
	avr_t *avr = eeprom->avr;
	eeprom->armed_until = 0;
	if (!eeprom->busy)
		return;
	/* "During reset, the EEPMn bits will be reset to 0b00 unless the EEPROM
	 * is busy programming" (8.6.3). */
	avr->data[REG_EECR] = latest(eeprom)->mode << 4;
	arm_timers(eeprom);
}

void eeprom_tear(struct eeprom *eeprom)
{
	if (!eeprom->busy)
		return;
	avr_t *avr = eeprom->avr;
	struct eeprom_operation *operation = latest(eeprom);
	uint8_t ones = eeprom->torn_ones;
	bool erasing = operation->mode == EEPROM_ERASE;
	if (operation->mode != EEPROM_ERASE && operation->mode != EEPROM_WRITE)
		erasing = avr->cycle < erased_at(eeprom);
	if (erasing)
		operation->stored = operation->old | ones;
	else if (operation->mode == EEPROM_WRITE)
		operation->stored = operation->old & (eeprom->target | ones);
	else
		operation->stored = eeprom->target | ones;
	operation->torn = true;
	eeprom->stock->eeprom[operation->address] = operation->stored;
	avr_cycle_timer_cancel(avr, finish, eeprom);
	avr_cycle_timer_cancel(avr, cut_power, eeprom);
	set_idle(eeprom);
}

void eeprom_keep_power(struct eeprom *eeprom)
{
	eeprom->ask.on = false;
	eeprom->cut = 0;
	avr_cycle_timer_cancel(eeprom->avr, cut_power, eeprom);
}

void eeprom_free(struct eeprom *eeprom)
{
	list_free(&eeprom->operations);
}
