/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recorder.h"

#include <simavr/avr_ioport.h>

/* Arduino's pin numbers: 0 to 7 are D0 to D7 (port D), 8 to 13 are D8 to D13 (port B), 14 to 19 are
 * A0 to A5 (port C). */
static const struct recorded_port board_ports[3] = {
	{ .name = 'D', .first_pin = 0, .pin_count = 8 },
	{ .name = 'B', .first_pin = 8, .pin_count = 6 },
	{ .name = 'C', .first_pin = 14, .pin_count = 6 },
};

static void on_pin(struct avr_irq_t *irq, uint32_t value, void *param)
{
	const struct recorded_port *port = param;
	struct recorder *recorder = port->recorder;
	uint8_t pin = port->first_pin + irq->irq;
	uint32_t bit = UINT32_C(1) << pin;
	uint8_t level = value & 1;
	if (!(recorder->pins & bit) || level == !!(recorder->levels & bit))
		return;
	recorder->levels ^= bit;
	struct edge *edge = list_push(&recorder->edges);
	*edge = (struct edge){ instruction_effect_cycle(recorder->instruction), pin, level };
}

static void on_mark(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct recorder *recorder = param;
	avr->data[address] = value;
	struct mark *mark = list_push(&recorder->marks);
	*mark = (struct mark){ instruction_effect_cycle(recorder->instruction), value };
}

static avr_irq_t *pin_irq(avr_t *avr, const struct recorded_port *port, int bit)
{
	return avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ(port->name), bit);
}

void recorder_attach(struct recorder *recorder, const struct instruction *instruction,
                     uint32_t pins)
{
	avr_t *avr = instruction->avr;
	*recorder = (struct recorder){
		.instruction = instruction,
		.pins = pins,
		.edges.item_size = sizeof(struct edge),
		.marks.item_size = sizeof(struct mark),
	};
	for (int i = 0; i < 3; i++) {
		struct recorded_port *port = &recorder->ports[i];
		*port = board_ports[i];
		port->recorder = recorder;
		for (int bit = 0; bit < port->pin_count; bit++)
			avr_irq_register_notify(pin_irq(avr, port, bit), on_pin, port);
	}
	avr_register_io_write(avr, REG_GPIOR0, on_mark, recorder);
}

void recorder_release_pins(struct recorder *recorder)
{
	avr_t *avr = recorder->instruction->avr;
	for (int i = 0; i < 3; i++) {
		const struct recorded_port *port = &recorder->ports[i];
		for (int bit = 0; bit < port->pin_count; bit++)
			avr_raise_irq(pin_irq(avr, port, bit), 0);
	}
}
