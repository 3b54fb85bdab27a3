#include "techniques/dnrt/bake/job.h"

bool dnrt_part_of_volume(struct dnrt_part *out, struct host *host,
                         const struct dnrt_objects *objects, const struct dnrt_key_poses *keys,
                         int volume)
{
    const struct dnrt_shape *shape = &objects->shapes[dnrt_shape_of_volume(objects, volume)];
    return dnrt_part_init(out, host, dnrt_pose_of_volume(objects, keys, volume), objects,
                          shape->object);
}

struct dnrt_sampling dnrt_sampling_of(const struct dnrt_job *job, int volume)
{
    const struct dnrt_shape_trace *shape = &job->volumes[volume];
    return (struct dnrt_sampling){
        .trace = shape->trace,
        .centre = shape->part.centre,
        .radius = shape->part.radius,
        .bands = dnrt_bands(&job->options),
        .rays = job->options.rays,
        .normals = dnrt_normals(&job->options),
        .self = job->options.self,
    };
}
