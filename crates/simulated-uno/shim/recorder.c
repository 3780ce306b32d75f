/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recorder.h"

#include <simavr/avr_ioport.h>

#define FIRST_RECORDED_PIN 2 /* D0 and D1 belong to the serial line */

static void on_pin(struct avr_irq_t *irq, uint32_t value, void *param)
{
	const struct recorded_pin *pin = param;
	struct recorder *recorder = pin->recorder;
	uint32_t bit = UINT32_C(1) << pin->number;
	uint8_t level = value & 1;
	if (level == !!(recorder->levels & bit))
		return;
	recorder->levels ^= bit;
	uint64_t cycle = instruction_store_cycle(recorder->instruction);
	list_push(&recorder->edges, &(struct edge){ cycle, pin->number, level });
}

static void on_mark(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct recorder *recorder = param;
	avr->data[address] = value;
	uint64_t cycle = instruction_store_cycle(recorder->instruction);
	list_push(&recorder->marks, &(struct mark){ cycle, value });
}

static avr_irq_t *pin_irq(avr_t *avr, int number)
{
	struct chip_pin pin = chip_find_pin(number);
	return avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ(pin.port), pin.bit);
}

void recorder_attach(struct recorder *recorder, const struct instruction *instruction)
{
	avr_t *avr = instruction->avr;
	*recorder = (struct recorder){
		.instruction = instruction,
		.edges.item_size = sizeof(struct edge),
		.marks.item_size = sizeof(struct mark),
	};
	for (int number = FIRST_RECORDED_PIN; number < CHIP_PIN_COUNT; number++) {
		recorder->pins[number] = (struct recorded_pin){ recorder, number };
		avr_irq_register_notify(pin_irq(avr, number), on_pin, &recorder->pins[number]);
	}
	avr_register_io_write(avr, REG_GPIOR0, on_mark, recorder);
}

void recorder_release_pins(struct recorder *recorder)
{
	avr_t *avr = recorder->instruction->avr;
	for (int number = 0; number < CHIP_PIN_COUNT; number++)
		avr_raise_irq(pin_irq(avr, number), 0);
}
