"""The device code of structures compiles for CUDA as well, which needs Warp's compiler but no GPU."""

import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.contact import ContactOptions, make_contact_kernels
from warpsph_kernels.structure import StructureOptions, make_stress_kernel, make_structure_kernels
from warpsph_kernels.structure_survey import make_observation_kernel, make_survey_kernel

SM_80 = 80


@pytest.mark.parametrize(
    ("dimension", "precision", "law", "plane_stress"),
    [(2, "double", "neo_hookean", True), (3, "single", "split_neo_hookean", False)],
)
def test_structures_compile_for_cuda(tmp_path, dimension, precision, law, plane_stress):
    options = StructureOptions(
        arithmetic=Arithmetic(dimension, precision),
        moving_clamps=True,
        loads=2,
        damped=True,
        contact=True,
        immersed=False,
        moving_walls=True,
        thin=True,
    )
    make_structure_kernels(options)
    for make in (make_stress_kernel, make_survey_kernel, make_observation_kernel):
        make(options, law, plane_stress)
    for name in (options.module, options.module_of(law, plane_stress)):
        wp.compile_aot_module(wp.get_module(name), arch=SM_80, module_dir=tmp_path, use_ptx=True)
    assert len(list(tmp_path.glob("*.ptx"))) == 2


@pytest.mark.parametrize(("dimension", "precision", "friction"), [(2, "double", False), (3, "single", True)])
def test_contact_compiles_for_cuda(tmp_path, dimension, precision, friction):
    options = ContactOptions(Arithmetic(dimension, precision), friction, own_surface=friction)
    make_contact_kernels(options)
    wp.compile_aot_module(wp.get_module(options.module), arch=SM_80, module_dir=tmp_path, use_ptx=True)
    assert len(list(tmp_path.glob("*.ptx"))) == 1


@pytest.mark.parametrize(("dimension", "precision"), [(2, "double"), (3, "single")])
def test_bonded_structures_compile_for_cuda(tmp_path, dimension, precision):
    options = StructureOptions(
        arithmetic=Arithmetic(dimension, precision),
        moving_clamps=False,
        loads=0,
        damped=False,
        contact=False,
        immersed=True,
        moving_walls=False,
        thin=False,
        bonded=True,
    )
    make_structure_kernels(options)
    wp.compile_aot_module(wp.get_module(options.module), arch=SM_80, module_dir=tmp_path, use_ptx=True)
    assert len(list(tmp_path.glob("*.ptx"))) == 1
