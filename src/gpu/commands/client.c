// Clients of a device: those for whom times and memory are counted separately.
#include "gpu/vk.h"

#include <string.h>

struct client *client_find(const struct gpu *gpu, uint32_t number)
{
    for (uint32_t i = 0; number && i < gpu->client_count; i++) {
        if (gpu->clients[i].number == number) return &gpu->clients[i];
    }
    return NULL;
}

uint32_t gpu_client_add(struct gpu *gpu)
{
    struct client *clients =
        host_realloc(gpu->host, gpu->clients, gpu->client_count + 1, sizeof *clients);
    if (!clients) return 0;
    gpu->clients = clients;
    struct client *client = &clients[gpu->client_count++];
    memset(client, 0, sizeof *client);
    client->number = ++gpu->newest_client;
    return client->number;
}

void gpu_client_remove(struct gpu *gpu, uint32_t number)
{
    struct client *client = client_find(gpu, number);
    if (gpu->client == number) gpu->client = 0;
    if (!client) return;
    *client = gpu->clients[--gpu->client_count];
}

void gpu_client_set(struct gpu *gpu, uint32_t client)
{
    gpu->client = client;
}

const struct gpu_counters *gpu_counters(const struct gpu *gpu)
{
    return &gpu->counters;
}
