/* A list that grows, and the bytes of a serial line in such a list. A list's owner may read its
 * `items` and `count`, and may empty it by setting `count` to 0.
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
struct serial_byte { uint64_t cycle; uint8_t value; };

/* The bytes of one direction of the serial line. */
struct serial_record {
	struct list bytes;  /* struct serial_byte */
	bool has_line_ended; /* set by each line feed; only the owner clears it */
};

void serial_record_init(struct serial_record *record);
void serial_record_push(struct serial_record *record, uint64_t cycle, uint8_t byte);
