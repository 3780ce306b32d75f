/* Growing arrays. A reader may read `items` and `count`, and may empty the list by setting
 * `count` to 0.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

struct list {
	void *items;
	size_t count;     /* number of items in use */
	size_t capacity;  /* number of allocated items */
	size_t item_size; /* size of an item, bytes */
};

/* Appends a copy of an item of `item_size` bytes. Aborts if memory runs out. */
void list_push(struct list *list, const void *item);

/* A byte on the serial line, with the cycle at which it was complete. */
struct serial_byte { uint64_t cycle; uint8_t byte; };

/* The bytes of one direction of the serial line. */
struct serial_bytes {
	struct list bytes;  /* struct serial_byte */
	bool has_line_ended; /* true after a line feed, until the reader resets it */
};

void serial_bytes_init(struct serial_bytes *bytes);
void serial_bytes_push(struct serial_bytes *bytes, uint64_t cycle, uint8_t byte);
