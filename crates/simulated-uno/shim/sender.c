/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sender.h"

#include <math.h>

#define FRAME_BITS 10.0 /* start bit, eight data bits, stop bit */
#define BITS_UNTIL_RECEIVED 9.5 /* a receiver samples the stop bit in its middle */

static avr_cycle_count_t begin_byte(avr_t *avr, avr_cycle_count_t when, void *param);

static bool take_next_byte(struct sender *sender, struct line_byte *byte)
{
	const struct line_byte *queued_bytes = sender->queue.items;
	const struct line_byte *flood_bytes = sender->flood.items;
	if (sender->next_index < sender->queue.count) {
		*byte = queued_bytes[sender->next_index++];
		if (sender->next_index == sender->queue.count)
			sender->next_index = sender->queue.count = 0;
		return true;
	}
	if (!sender->flood.count)
		return false;
	*byte = flood_bytes[sender->flood_position];
	sender->flood_position = (sender->flood_position + 1) % sender->flood.count;
	return true;
}

static avr_cycle_count_t deliver_byte(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct sender *sender = param;
	sender->is_busy = false;
	const struct receiver *receiver = &sender->receiver;
	uint8_t received = receiver->receive_byte(receiver->param, sender->current_byte,
	                                          sender->current_cycles_per_bit);
	serial_record_push(&sender->delivered, avr->cycle, received);
	/* Check again when the line is free, even if the queue is empty now: a byte that is queued
	 * meanwhile starts at that cycle. */
	chip_call_at(avr, ceil(sender->line_free_at), begin_byte, sender);
	return 0;
}

static avr_cycle_count_t begin_byte(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct sender *sender = param;
	const struct receiver *receiver = &sender->receiver;
	if (sender->is_busy || !take_next_byte(sender, &sender->current_byte))
		return 0;
	/* If the last byte has only just ended, `when` is `line_free_at` rounded up. The fraction carries
	 * over, so the rate is right in the long run. */
	double start = sender->line_free_at > when - 1.0 ? sender->line_free_at : when;
	double frame_cycles = FRAME_BITS * sender->cycles_per_bit;
	sender->current_cycles_per_bit = sender->cycles_per_bit;
	sender->is_busy = true;
	sender->sent_count++;
	sender->line_free_at = start + receiver->begin_frame(receiver->param, frame_cycles);
	uint64_t received_at = ceil(start + BITS_UNTIL_RECEIVED * sender->cycles_per_bit);
	chip_call_at(avr, received_at, deliver_byte, sender);
	return 0;
}

/* Schedules the next byte, if any, unless a byte is on the line or already scheduled. */
static void schedule_next_byte(struct sender *sender, uint64_t now)
{
	avr_t *avr = sender->avr;
	bool is_empty = sender->next_index == sender->queue.count && !sender->flood.count;
	if (is_empty || sender->is_busy || avr_cycle_timer_status(avr, begin_byte, sender))
		return;
	uint64_t free_at = ceil(sender->line_free_at);
	uint64_t begin = now > avr->cycle ? now : avr->cycle;
	if (free_at > begin)
		begin = free_at;
	avr_cycle_timer_register(avr, begin - avr->cycle, begin_byte, sender);
}

void sender_attach(struct sender *sender, avr_t *avr, struct receiver receiver, double baud)
{
	*sender = (struct sender){
		.avr = avr,
		.receiver = receiver,
		.queue.item_size = sizeof(struct line_byte),
		.flood.item_size = sizeof(struct line_byte),
	};
	serial_record_init(&sender->delivered);
	sender_set_baud(sender, baud);
}

void sender_reset(struct sender *sender, uint64_t now)
{
	sender->is_busy = false;
	schedule_next_byte(sender, now);
}

void sender_set_baud(struct sender *sender, double baud)
{
	sender->cycles_per_bit = CHIP_FREQUENCY / baud;
}

static void append_bytes(struct list *list, const uint8_t *bytes, size_t length,
                         bool is_stop_bit_low)
{
	for (size_t i = 0; i < length; i++)
		list_push(list, &(struct line_byte){ bytes[i], is_stop_bit_low });
}

void sender_send(struct sender *sender, const uint8_t *bytes, size_t length, bool is_stop_bit_low,
                 uint64_t now)
{
	append_bytes(&sender->queue, bytes, length, is_stop_bit_low);
	schedule_next_byte(sender, now);
}

void sender_set_flood(struct sender *sender, const uint8_t *bytes, size_t length, uint64_t now)
{
	sender->flood.count = sender->flood_position = 0;
	append_bytes(&sender->flood, bytes, length, false);
	schedule_next_byte(sender, now);
}

size_t sender_unsent_count(const struct sender *sender)
{
	return sender->queue.count - sender->next_index + sender->is_busy;
}
