// What is measured of each method: where it stands in the report, what it means, which way is better.

const MEBIBYTE = 1024 * 1024;
const memoryOf = method => {
  const sizes = Object.values(method.memory_bytes ?? {}).filter(isNumber);
  return sizes.length ? sizes.reduce((sum, bytes) => sum + bytes, 0) : undefined;
};
// Of several frames the first is not measured: it pays for what later ones find ready.
const framesTimed = isNumber(report.frames) ? Math.max(report.frames - 1, 1) : undefined;
const frames = framesTimed ? ` over ${framesTimed} ${framesTimed === 1 ? 'frame' : 'frames'}` : '';

// better: 'low', 'high' or 'one'. plot: the name in the scatter plot, where a metric is an error (asError makes it one).
const METRICS = [
  {
    group: 'Image', name: 'FLIP', better: 'low', unit: 'no unit', plot: 'FLIP', value: m => m.flip,
    meaning: 'What somebody sees who flips between the image and the reference on one spot of a screen: 0 is no visible ' +
      'difference, 1 the largest.',
  }, {
    group: 'Image', name: 'relMSE', better: 'low', unit: 'no unit', plot: 'relMSE', value: m => m.relmse,
    meaning: 'Relative mean squared error of the light: the squared error over the squared reference, so that dark parts ' +
      'count as much as bright ones, whatever the exposure.',
  }, {
    group: 'Image', name: 'MAE', better: 'low', unit: 'cd/m²', plot: 'MAE (cd/m²)', value: m => m.mae, hidden: true,
    meaning: 'Mean absolute error of the light.',
  }, {
    group: 'Image', name: 'SSIM', better: 'high', unit: 'no unit, at most 1', plot: '1 − SSIM', value: m => m.ssim,
    asError: value => 1 - value,
    meaning: 'Structural similarity: 1 where the structure is the same. Forgives a change of brightness, punishes lost ' +
      'detail and noise.',
  }, {
    group: 'Image', name: 'mean ratio', better: 'one', unit: 'ratio', value: m => m.energy,
    meaning: 'Mean luminance over the reference’s. Below 1 light is missing, above 1 there is too much.',
  }, {
    group: 'Indirect light', name: 'relMSE', better: 'low', unit: 'no unit', plot: 'relMSE of indirect light',
    value: m => m.indirect?.relmse, hidden: true,
    meaning: 'Relative mean squared error of the indirect light alone.',
  }, {
    group: 'Indirect light', name: 'MAE', better: 'low', unit: 'cd/m²', plot: 'MAE of indirect light (cd/m²)',
    value: m => m.indirect?.mae,
    meaning: 'Mean absolute error of the indirect light alone: what direct light hides in the image shows here.',
  }, {
    group: 'Indirect light', name: 'mean ratio', better: 'one', unit: 'ratio', value: m => m.indirect?.energy,
    meaning: 'Mean luminance of the indirect light over the reference’s. Below 1 light is missing, above 1 there is too ' +
      'much.',
  }, {
    group: 'Cost', name: 'frame ms', better: 'low', unit: 'milliseconds', value: m => m.frame_ms?.median,
    meaning: `GPU time of a whole frame, the median${frames}.`,
  }, {
    group: 'Cost', name: 'p95 ms', better: 'low', unit: 'milliseconds', value: m => m.frame_ms?.p95,
    meaning: `GPU time that 95 % of the frames do not exceed${frames}.`,
  }, {
    group: 'Cost', name: 'memory MiB', better: 'low', unit: 'MiB (1 048 576 bytes)',
    value: m => isNumber(memoryOf(m)) ? memoryOf(m) / MEBIBYTE : undefined,
    meaning: 'GPU memory of the frame, the scene and the method together.',
  },
];

const WAY = { low: 'Lower is better.', high: 'Higher is better.', one: 'Closer to 1 is better.' };

// Smaller is better, for any metric; a value that is not there is worst.
function badness(metric, value) {
  if (!isNumber(value)) return Infinity;
  if (metric.better === 'one') return value > 0 ? Math.abs(Math.log(value)) : Number.MAX_VALUE;
  return metric.better === 'high' ? -value : value;
}

const valuesOf = metric => methods.map(method => metric.value(method));
const isMeasured = metric => valuesOf(metric).some(isNumber);
const errorOf = (metric, method) => {
  const value = metric.value(method);
  return isNumber(value) && metric.asError ? metric.asError(value) : value;
};
