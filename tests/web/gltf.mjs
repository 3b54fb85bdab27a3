// gltf.mjs FILE…: no error, and no warning, by the validator of Khronos. It does not know MOZ_lightmap, and lists that and the
// unused coordinates as information.
import { readFileSync } from 'node:fs';
import validator from 'gltf-validator';

let wrong = 0;
for (const path of process.argv.slice(2)) {
  const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(path)), { uri: path, maxIssues: 0 });
  console.log(`${path}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
  for (const issue of issues.messages.filter(m => m.severity < 2))
    console.log(`  ${issue.severity === 0 ? 'error' : 'warning'} ${issue.code} ${issue.pointer}: ${issue.message}`);
  if (issues.numErrors > 0) wrong = 1;
}
process.exit(wrong);
