/* The other end of the serial cable: a PC's UART, which sends one byte after
 * another with no pause between the stop bit and the next start bit, whether or not the
 * UNO keeps up.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "list.h"

/* A byte on the line. */
struct line_byte {
	uint8_t value;
	bool stop_low;  /* the line is low where the stop bit should be */
};

/* The UART at the UNO's end of the cable. */
struct receiver {
	void *param;
	/* Cycles from one start bit to the next, given the sender's own. */
	double (*frame_cycles)(void *param, double frame);
	void (*start_bit)(void *param);
	/* Returns what is received: 0xff in place of a byte with a framing error. */
	uint8_t (*byte)(void *param, struct line_byte byte, double cycles_per_bit);
};

struct sender {
	avr_t *avr;
	struct receiver receiver;
	double cycles_per_bit;
	double line_free;               /* cycle at which the last stop bit ends */
	struct list queue;              /* struct line_byte */
	size_t next;                    /* first unsent byte of the queue */
	uint8_t *flood;                 /* sent repeatedly once the queue is empty */
	size_t flood_length, flood_next;
	uint64_t sent;                  /* bytes put on the line */
	struct line_byte byte;          /* on the line now */
	bool busy;
	struct serial_bytes delivered;  /* complete at the receiver */
};

void sender_attach(struct sender *sender, avr_t *avr, struct receiver receiver, double baud);
/* simavr's reset drops all its timers, the sender's too. */
void sender_reset(struct sender *sender, uint64_t now);
void sender_set_baud(struct sender *sender, double baud);
/* `now` in all of these: the cycle reached, which is ahead of avr->cycle while
 * the CPU sleeps. */
void sender_send(struct sender *sender, const uint8_t *bytes, size_t length, bool stop_low,
                 uint64_t now);
/* Repeats `bytes` forever once the queue is empty; length 0 ends it. */
void sender_flood(struct sender *sender, const uint8_t *bytes, size_t length, uint64_t now);
/* The number of queued bytes that have not arrived. */
size_t sender_unsent(const struct sender *sender);
