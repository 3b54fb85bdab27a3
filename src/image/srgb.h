// The sRGB curve, of one channel.
#pragma once

float srgb_encode(float linear);
float srgb_decode(float encoded);
