"""All device code compiles for CUDA as well, which needs Warp's compiler but no GPU."""

import pytest
import warp as wp
from warpsph_kernels import reorder
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.boundary import make_wall_kernels
from warpsph_kernels.cells import make_cell_kernels, make_list_kernel
from warpsph_kernels.clock import make_clock_kernels
from warpsph_kernels.density_gradient import make_density_gradient
from warpsph_kernels.faces import make_face_kernels
from warpsph_kernels.fluid import make_fluid_kernels
from warpsph_kernels.gradient_correction import make_finite_particle_kernels, make_renormalised_kernels
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.particle_order import make_order_kernels
from warpsph_kernels.stress import make_stress_kernels
from warpsph_kernels.structure import StructureOptions, make_stress_kernel, make_structure_kernels
from warpsph_kernels.structure_survey import make_observation_kernel, make_survey_kernel
from warpsph_kernels.summation import make_sum_density
from warpsph_kernels.wall_motion import make_move
from warpsph_kernels.wall_surface import make_surface_kernels

SM_80 = 80
CONCEPTS = ("stress", "density_gradient", "order", "summation", "gradient_correction")


@pytest.mark.parametrize(
    ("dimension", "precision", "law"), [(2, "double", "neo_hookean"), (3, "single", "split_neo_hookean")]
)
def test_structure_code_compiles_for_cuda(tmp_path, dimension, precision, law):
    arithmetic = Arithmetic(dimension, precision)
    options = StructureOptions(
        arithmetic=arithmetic,
        moving_clamps=True,
        loads=2,
        damped=True,
        contact=False,
        immersed=True,
        moving_walls=False,
        thin=True,
    )
    make_structure_kernels(options)
    for make in (make_stress_kernel, make_survey_kernel, make_observation_kernel):
        make(options, law, False)
    for name in (options.module, options.module_of(law, False)):
        wp.compile_aot_module(wp.get_module(name), arch=SM_80, module_dir=tmp_path, use_ptx=True)
    assert len(list(tmp_path.glob("*.ptx"))) == 2


@pytest.mark.parametrize(
    ("dimension", "precision", "wall"), [(2, "double", "dynamic"), (3, "single", "extrapolated")]
)
def test_device_code_compiles_for_cuda(tmp_path, dimension, precision, wall):
    arithmetic = Arithmetic(dimension, precision)
    periodic = (True,) + (False,) * (dimension - 1)
    options = FluidOptions(
        arithmetic=arithmetic,
        periodic=periodic,
        smoothing="wendland_c2",
        state="tait",
        pressure_form="symmetric" if dimension == 3 else "riemann",
        density_diffusion="delta_sph",
        viscosity="artificial",
        wall=wall,
        wall_suction=False,
        wall_friction=True,
        particle_order="transport_velocity" if dimension == 2 else "shifting",
        density="mixed",
        kernel_gradient="renormalised" if dimension == 2 else "finite_particle",
        stress="carreau" if dimension == 2 else "sub_particle_scale",
    )
    make_fluid_kernels(options)
    make_wall_kernels(options)
    make_move(options)
    make_surface_kernels(options)
    make_stress_kernels(options)
    make_density_gradient(options)
    make_order_kernels(options)
    make_correction = make_renormalised_kernels if dimension == 2 else make_finite_particle_kernels
    make_correction(options)
    make_sum_density(options)
    faces = make_face_kernels(options, moving_clamps=dimension == 2)
    sided = [make_list_kernel(arithmetic, periodic, which) for which in ("targets", "sources")]
    cells = make_cell_kernels(arithmetic, periodic, lanes=1).module
    clock = make_clock_kernels(arithmetic, options.state).module
    extra = [options.module_of(concept) for concept in CONCEPTS]
    of_structures = [kernel.module.name for kernel in (faces.place, *sided)]
    modules = (options.module, *extra, *of_structures, cells, clock, reorder.MODULE)
    for name in modules:
        wp.compile_aot_module(wp.get_module(name), arch=SM_80, module_dir=tmp_path, use_ptx=True)
    assert len(list(tmp_path.glob("*.ptx"))) == len(modules)
