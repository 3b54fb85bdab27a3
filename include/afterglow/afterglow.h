/// Real-time global illumination on any Vulkan 1.3 device. This header includes all others;
/// examples/minimal.c is a first program.
#ifndef AFTERGLOW_H
#define AFTERGLOW_H

#include <afterglow/bake.h>
#include <afterglow/block_map.h>
#include <afterglow/catalogue.h>
#include <afterglow/context.h>
#include <afterglow/device.h>
#include <afterglow/environment.h>
#include <afterglow/image.h>
#include <afterglow/lightmap.h>
#include <afterglow/preparation.h>
#include <afterglow/probes.h>
#include <afterglow/reference.h>
#include <afterglow/renderer.h>
#include <afterglow/scene.h>
#include <afterglow/texture.h>
#include <afterglow/types.h>
#include <afterglow/view.h>

#endif
