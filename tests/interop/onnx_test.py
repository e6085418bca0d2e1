"""Exported ONNX models in onnx.checker and ONNX Runtime, against the network in
double precision, which weights_test.py compares with the library."""
from common import all_networks, check, directions, np, path, program, require
import reference

onnx, onnxruntime = require("onnx", "onnxruntime")
options = onnxruntime.SessionOptions()
options.intra_op_num_threads = options.inter_op_num_threads = 1

wi, wo = directions(4000)
for name, encoding, file in all_networks():
    model_file = path(name + ".onnx")
    program("export", f"--fit={file}", "--format=onnx", f"--out={model_file}")
    model = onnx.load(model_file)
    onnx.checker.check_model(model, full_check=True)
    assert [(v.name, v.type.tensor_type.elem_type, v.type.tensor_type.shape.dim[1].dim_value)
            for v in [*model.graph.input, *model.graph.output]] == [
                ("wi", onnx.TensorProto.FLOAT, 3), ("wo", onnx.TensorProto.FLOAT, 3),
                ("rgb", onnx.TensorProto.FLOAT, 3)]

    session = onnxruntime.InferenceSession(model_file, options, providers=["CPUExecutionProvider"])
    rgb, = session.run(None, {"wi": wi, "wo": wo})
    expected = reference.evaluate(reference.read(file), wi, wo)
    assert rgb.shape == expected.shape and rgb.dtype == np.float32
    assert (expected > 0).any() and (expected[:-4] == 0).any() and (rgb[-4:] == 0).all()
    # As onnx_model.h promises.
    allowed = 1e-5 * expected + 1e-6
    if encoding == "merl":
        allowed = 1e-4 * (1 + expected)
    check(f"{name}, error over what is allowed", np.max(np.abs(rgb - expected) / allowed), 1)

    exchanged, = session.run(None, {"wi": wo, "wo": wi})
    differ = np.count_nonzero(np.any(exchanged.view(np.uint32) != rgb.view(np.uint32), axis=1))
    if encoding in reference.NOT_RECIPROCAL:
        assert differ > 1000  # the comparison can fail
    else:
        check(f"{name}, pairs that aren't reciprocal to the bit", differ, 0)
    one, = session.run(None, {"wi": wi[:1], "wo": wo[:1]})  # the first dimension is free
    check(f"{name}, one pair alone", np.max(np.abs(one - rgb[:1]) / (1 + rgb[:1])), 1e-6)
