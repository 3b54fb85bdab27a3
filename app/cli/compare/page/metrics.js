// Metrics of methods: value in the report, explanation, better direction.

const MEBIBYTE = 1024 * 1024;
const memoryOf = method => {
  const sizes = Object.values(method.memory_bytes ?? {}).filter(isNumber);
  return sizes.length ? sizes.reduce((sum, bytes) => sum + bytes, 0) : undefined;
};
// The first of several frames is not measured: it includes one-time work.
const framesTimed = isNumber(report.frames) ? Math.max(report.frames - 1, 1) : undefined;
const frames = framesTimed ? ` over ${framesTimed} ${framesTimed === 1 ? 'frame' : 'frames'}` : '';

// better: 'low', 'high' or 'one'. plot: name in the scatter plot, for error metrics (asError converts a metric to one).
const METRICS = [
  {    group: 'Indirect light', name: 'relMSE', better: 'low', unit: 'no unit', plot: 'relMSE of indirect light',
    value: m => m.indirect?.relmse,
    meaning: 'Relative mean squared error of indirect light only.',
  }, {
    group: 'Indirect light', name: 'MAE', better: 'low', unit: 'cd/m²', plot: 'MAE of indirect light (cd/m²)',
    value: m => m.indirect?.mae,
    meaning: 'Mean absolute error of indirect light only, without direct light to hide it.',
  }, {
    group: 'Indirect light', name: 'energy', better: 'one', unit: 'ratio', value: m => m.indirect?.energy,
    meaning: 'Mean luminance of indirect light divided by the reference’s. Below 1 light is missing, above 1 there is too much.',
  }, {
    group: 'Image', name: 'FLIP', better: 'low', unit: 'no unit', plot: 'FLIP', value: m => m.flip,
    meaning: 'Visible difference when flipping between the image and the reference on a screen: 0 is none, 1 the largest.',
  }, {
    group: 'Image', name: 'relMSE', better: 'low', unit: 'no unit', plot: 'relMSE', value: m => m.relmse,
    meaning: 'Relative mean squared error: squared error divided by squared reference. Dark and bright areas count equally; ' +
      'exposure does not matter.',
  }, {
    group: 'Image', name: 'MAE', better: 'low', unit: 'cd/m²', plot: 'MAE (cd/m²)', value: m => m.mae, hidden: true,
    meaning: 'Mean absolute error of radiance.',
  }, {
    group: 'Image', name: 'SSIM', better: 'high', unit: 'no unit, at most 1', plot: '1 − SSIM', value: m => m.ssim,
    asError: value => 1 - value,
    meaning: 'Structural similarity: 1 is equal. Tolerates changes of brightness, penalizes lost detail and noise.',
  }, {
    group: 'Image', name: 'energy', better: 'one', unit: 'ratio', value: m => m.energy,
    meaning: 'Mean luminance divided by the reference’s. Below 1 light is missing, above 1 there is too much.',
  }, {
    group: 'Cost', name: 'frame ms', better: 'low', unit: 'milliseconds', value: m => m.frame_ms?.median,
    meaning: `Median GPU time of a frame${frames}.`,
  }, {
    group: 'Cost', name: 'p95 ms', better: 'low', unit: 'milliseconds', value: m => m.frame_ms?.p95,
    meaning: `95th percentile of the GPU time of a frame${frames}.`,
  }, {
    group: 'Cost', name: 'memory MiB', better: 'low', unit: 'MiB (1 048 576 bytes)',
    value: m => isNumber(memoryOf(m)) ? memoryOf(m) / MEBIBYTE : undefined,
    meaning: 'GPU memory of frame, scene and method.',
  },
];

const DIRECTION = { low: 'Lower is better.', high: 'Higher is better.', one: 'Closer to 1 is better.' };

// Sort key: smaller is better for every metric; missing values come last.
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
