/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recorder.h"

#include <simavr/avr_ioport.h>

/* Arduino's numbers: D0 to D7 are port D, D8 to D13 port B, and 14 to 19 are
 * A0 to A5, port C. */
static const struct recorded_port board[3] = {
	{ .name = 'D', .first = 0, .bits = 8 },
	{ .name = 'B', .first = 8, .bits = 6 },
	{ .name = 'C', .first = 14, .bits = 6 },
};

static void on_pin(struct avr_irq_t *irq, uint32_t value, void *param)
{
	const struct recorded_port *port = param;
	struct recorder *recorder = port->recorder;
	uint8_t pin = port->first + irq->irq;
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

void recorder_attach(struct recorder *recorder, const struct instruction *instruction,
                     uint32_t pins)
{
	avr_t *avr = instruction->avr;
	*recorder = (struct recorder){
		.instruction = instruction,
		.pins = pins,
		.edges.size = sizeof(struct edge),
		.marks.size = sizeof(struct mark),
	};
	for (int i = 0; i < 3; i++) {
		struct recorded_port *port = &recorder->ports[i];
		*port = board[i];
		port->recorder = recorder;
		for (int bit = 0; bit < port->bits; bit++)
			avr_irq_register_notify(
				avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ(port->name), bit),
				on_pin, port);
	}
	avr_register_io_write(avr, REG_GPIOR0, on_mark, recorder);
}

void recorder_release_pins(struct recorder *recorder)
{
	avr_t *avr = recorder->instruction->avr;
	for (int i = 0; i < 3; i++) {
		const struct recorded_port *port = &recorder->ports[i];
		for (int bit = 0; bit < port->bits; bit++)
			avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ(port->name), bit),
			              0);
	}
}

void recorder_free(struct recorder *recorder)
{
	list_free(&recorder->edges);
	list_free(&recorder->marks);
}
