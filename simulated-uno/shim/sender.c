/* The other end of the serial cable.
 *
 * A PC's UART sends one byte after another with nothing between the stop bit
 * and the next start bit. It does not know whether the UNO keeps up.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "uno.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FRAME_BITS 10.0   /* start, eight data, stop */
#define SAMPLED_BITS 9.5  /* a receiver is done in the middle of the stop bit */

static avr_cycle_count_t begin_byte(avr_t *avr, avr_cycle_count_t when, void *param);

/* Stock simavr takes 11 bits for a frame: sent at the true rate, a long stream
 * would overflow its 64 bytes, which no UNO has. So it gets what it can take. */
static double frame_cycles(const struct uno *uno)
{
	double frame = FRAME_BITS * uno->sender.cycles_per_bit;
	double stock = uno->stock_uart->cycles_per_byte;
	return uno->data_sheet || stock < frame ? frame : stock;
}

static bool next_byte(struct sender *sender, uint8_t *byte)
{
	const uint8_t *queue = sender->queue.items;
	if (sender->next < sender->queue.count) {
		*byte = queue[sender->next++];
		if (sender->next == sender->queue.count)
			sender->next = sender->queue.count = 0;
		return true;
	}
	if (!sender->flood_length)
		return false;
	*byte = sender->flood[sender->flood_next];
	sender->flood_next = (sender->flood_next + 1) % sender->flood_length;
	return true;
}

static avr_cycle_count_t end_byte(avr_t *avr, avr_cycle_count_t when, void *param)
{
	(void)when;
	struct uno *uno = param;
	struct sender *sender = &uno->sender;
	sender->busy = false;
	struct stamped_byte *heard = list_push(&uno->heard);
	*heard = (struct stamped_byte){ avr->cycle, sender->byte };
	if (uno->data_sheet)
		usart_receive(uno, sender->byte, sender->cycles_per_bit);
	else
		avr_raise_irq(uno->stock_uart->io.irq + UART_IRQ_INPUT, sender->byte);
	/* Always look again when the line is free: a byte queued meanwhile starts
	 * then. */
	uint64_t start = ceil(sender->line_free);
	uint64_t wait = start > avr->cycle ? start - avr->cycle : 1;
	avr_cycle_timer_register(avr, wait, begin_byte, uno);
	return 0;
}

static avr_cycle_count_t begin_byte(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct uno *uno = param;
	struct sender *sender = &uno->sender;
	if (sender->busy || !next_byte(sender, &sender->byte))
		return 0;
	/* Fractions of a cycle carry over, so the rate is right in the long run. */
	double start = sender->line_free > when - 1.0 ? sender->line_free : when;
	sender->busy = true;
	sender->sent++;
	sender->line_free = start + frame_cycles(uno);
	if (uno->data_sheet)
		usart_start_bit(uno);
	uint64_t end = ceil(start + SAMPLED_BITS * sender->cycles_per_bit);
	avr_cycle_timer_register(avr, end > avr->cycle ? end - avr->cycle : 1, end_byte, uno);
	return 0;
}

/* Starts to send if there is something to send and the line is free. */
void sender_wake(struct uno *uno)
{
	struct sender *sender = &uno->sender;
	avr_t *avr = uno->avr;
	bool empty = sender->next == sender->queue.count && !sender->flood_length;
	if (empty || sender->busy || avr_cycle_timer_status(avr, begin_byte, uno))
		return;
	/* Asleep, simavr's clock may lag behind ours. */
	uint64_t now = uno->now > avr->cycle ? uno->now : avr->cycle;
	uint64_t free = ceil(sender->line_free);
	uint64_t start = free > now ? free : now;
	avr_cycle_timer_register(avr, start - avr->cycle, begin_byte, uno);
}

void uno_send(struct uno *uno, const uint8_t *bytes, size_t length)
{
	for (size_t i = 0; i < length; i++)
		*(uint8_t *)list_push(&uno->sender.queue) = bytes[i];
	sender_wake(uno);
}

/* Repeats `bytes` for ever after what is queued; length 0 ends it. */
void uno_flood(struct uno *uno, const uint8_t *bytes, size_t length)
{
	struct sender *sender = &uno->sender;
	free(sender->flood);
	sender->flood = NULL;
	sender->flood_length = length;
	sender->flood_next = 0;
	if (!length)
		return;
	sender->flood = malloc(length);
	if (!sender->flood)
		abort();
	memcpy(sender->flood, bytes, length);
	sender_wake(uno);
}

size_t uno_unsent(const struct uno *uno)
{
	return uno->sender.queue.count - uno->sender.next + uno->sender.busy;
}

uint64_t uno_sent(const struct uno *uno) { return uno->sender.sent; }
void uno_set_baud(struct uno *uno, double baud) { uno->sender.cycles_per_bit = UNO_FREQUENCY / baud; }
