/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "list.h"

#include <stdlib.h>

void *list_push(struct list *list)
{
	if (list->count == list->room) {
		list->room = list->room ? list->room * 2 : 1024;
		list->items = realloc(list->items, list->room * list->size);
		if (!list->items)
			abort();
	}
	return (char *)list->items + list->size * list->count++;
}

void list_free(struct list *list)
{
	free(list->items);
	*list = (struct list){ .size = list->size };
}
