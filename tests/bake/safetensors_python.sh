#!/bin/sh
# The reference implementation of safetensors reads our files.   safetensors_python.sh TEST_PROGRAM
set -eu
python3 -c 'import numpy, safetensors' 2>/dev/null || {
    echo "skipped: no numpy or safetensors for python3"
    exit 77
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
AFTERGLOW_SAFETENSORS_SAMPLE=$folder/sample.safetensors "$1" safetensors safetensors_sample_for_other_readers >/dev/null
python3 - "$folder/sample.safetensors" <<'PYTHON'
import sys
import numpy
from safetensors import safe_open
from safetensors.numpy import load_file
tensors = load_file(sys.argv[1])
assert sorted(tensors) == ['cube/1/U_b', 'empty', 'half', 'mask', 'scalar "ü"'], sorted(tensors)
assert tensors['cube/1/U_b'].dtype == numpy.float32
assert (tensors['cube/1/U_b'] == [[1, 2, 3], [4, 5, 6.5]]).all()
assert (tensors['half'] == numpy.array([[1, -2]], numpy.float16)).all()
assert (tensors['mask'] == [7, 8, 9]).all()
assert tensors['scalar "ü"'] == -5
assert tensors['empty'].shape == (4, 0)
with safe_open(sys.argv[1], framework='np') as file:
    assert file.metadata() == {'afterglow.technique': 'test', 'afterglow.options': 'a=1,b=\\2'}
print('read')
PYTHON
