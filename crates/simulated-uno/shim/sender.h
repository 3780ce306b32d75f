/* The other end of the serial cable: a PC's UART. It sends bytes back to back, without a pause
 * between a stop bit and the next start bit, even if the UNO does not keep up.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "list.h"

/* A byte on the line. */
struct line_byte {
	uint8_t value;
	bool is_stop_bit_low;  /* the line is low during the stop bit */
};

/* The UART at the UNO's end of the cable. */
struct receiver {
	void *param;
	/* Called when a start bit begins. Returns the number of cycles until the next start bit may
	 * begin, given the length of the sender's frame. */
	double (*begin_frame)(void *param, double sender_frame_cycles);
	/* Takes a byte from the line. Returns the received value, or 0xff after a framing error.
	 * `cycles_per_bit`: the length of the sender's bits. */
	uint8_t (*receive_byte)(void *param, struct line_byte byte, double cycles_per_bit);
};

struct sender {
	avr_t *avr;
	struct receiver receiver;
	double cycles_per_bit;          /* the length of a bit of the next byte */
	double line_free_at;            /* cycle at which the last stop bit ends */
	struct list queue;              /* struct line_byte */
	size_t next_index;              /* index of the first unsent byte in the queue */
	struct list flood;              /* sent repeatedly while the queue is empty: struct line_byte */
	size_t flood_position;          /* index of the next byte in `flood` */
	uint64_t sent_count;            /* number of bytes put on the line so far */
	struct line_byte current_byte;  /* the byte on the line while `is_busy` */
	double current_cycles_per_bit;  /* the length of a bit of `current_byte` */
	bool is_busy;                   /* a byte is on the line, and the receiver has not read it yet */
	struct serial_record delivered;  /* bytes that have arrived at the receiver */
};

void sender_attach(struct sender *sender, avr_t *avr, struct receiver receiver, double baud);
/* Resumes sending; must be called after simavr's reset, which drops all timers. The byte on the line
 * is lost. */
void sender_reset(struct sender *sender, uint64_t now);
void sender_set_baud(struct sender *sender, double baud);
/* Queues bytes. `now`, also below: the current cycle, which may be ahead of avr->cycle while the CPU
 * sleeps. */
void sender_send(struct sender *sender, const uint8_t *bytes, size_t length, bool is_stop_bit_low,
                 uint64_t now);
/* Sends `bytes` repeatedly whenever the queue is empty; length 0 ends the flood. */
void sender_set_flood(struct sender *sender, const uint8_t *bytes, size_t length, uint64_t now);
/* The number of queued bytes that have not yet arrived. */
size_t sender_unsent_count(const struct sender *sender);
