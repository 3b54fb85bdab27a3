// Messages between the ranks of a team.
#include "bake/message.h"

#include <string.h>

bool message_send(struct host *host, const struct bake_team *team, int to,
                  const struct message *message, const void *bytes, size_t size)
{
    char *data = host_alloc(host, sizeof *message + size, 1);
    if (!data) return false;
    memcpy(data, message, sizeof *message);
    if (size > 0) memcpy(data + sizeof *message, bytes, size);
    const bool ok = team->send(team->user, to, data, sizeof *message + size);
    host_free(host, data);
    return ok;
}

bool message_send_text(struct host *host, const struct bake_team *team, int to,
                       enum message_kind kind, uint64_t count, const char *text)
{
    const struct message message = { .kind = (uint32_t)kind, .count = count };
    return message_send(host, team, to, &message, text, strlen(text) + 1);
}

bool message_parse(const void *data, size_t size, struct message *out, const char **bytes,
                   size_t *byte_count)
{
    if (size < sizeof *out) return false;
    memcpy(out, data, sizeof *out);
    *bytes = (const char *)data + sizeof *out;
    *byte_count = size - sizeof *out;
    return true;
}
