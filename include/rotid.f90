! rotid for Fortran 2008: the twin of rotid.h, where the comments on every constant, type, member and routine stand.
!
! What is in this module
!   Constants, types and routines have the names of rotid.h; only the text ROTID_VERSION is ROTID_VERSION_TEXT here, since
!   rotid_version is a function. A pointer to a function, member X of rotid_Y, has the abstract interface rotid_Y_X.
!   The routines of rotid.h are bound to C as they are: every index that they take or give counts from 0, and what may be a
!   null pointer is type(c_ptr) or type(c_funptr), by value.
!   The routines at the end (module procedures) are for Fortran: they take arrays, strings and optional arguments, and every
!   index that they take counts from 1.
!   Members of types are as in C: pointers to arrays are type(c_ptr), seen through rotid_reals, rotid_integers or
!   c_f_pointer, and indices in them count from 0. A type starts out as zeros and null pointers, so that a constructor names
!   only the members that matter: rotid_parameter(lower=1e9_c_double, upper=1e12_c_double, start=2e11_c_double).
!   Types that begin with `size` start out with that of 64-bit machines; elsewhere the routines for Fortran set it, and hosts that
!   call the others have to.
!   `failure`, optional in the routines for Fortran, becomes why the status is an error, and empty where it is none. In this text
!   arguments have their names of rotid.h, and indices count from 0.
!   What a callback changes through `user` or `context` needs the attribute target, and so does the rotid_model, rotid_environment
!   or rotid_matrix that names it; else a compiler that optimises may take it for unchanged.
!
! Compile this file with the compiler of the host, then link with `pkg-config --libs rotid`.
module rotid
  use, intrinsic :: iso_c_binding, only: c_int, c_long, c_size_t, c_double, c_char, c_ptr, c_funptr, c_null_ptr, c_null_funptr, &
                                         c_null_char, c_loc, c_funloc, c_sizeof, c_associated, c_f_pointer
  implicit none

  character(len=*), parameter :: ROTID_VERSION_TEXT = "0.3.0"
  integer(c_int), parameter :: ROTID_VERSION_MAJOR = 0
  integer(c_int), parameter :: ROTID_VERSION_MINOR = 3
  integer(c_int), parameter :: ROTID_VERSION_PATCH = 0

  ! ------------------------------------------------------------------------------------------------ constants

  ! of the text `failure`, with the zero that ends it
  integer(c_int), parameter :: ROTID_FAILURE_LENGTH = 512

  ! status
  integer(c_int), parameter :: ROTID_OK = 0
  integer(c_int), parameter :: ROTID_STOP_GRADIENT = 1
  integer(c_int), parameter :: ROTID_STOP_STEP = 2
  integer(c_int), parameter :: ROTID_STOP_OBJECTIVE = 3
  integer(c_int), parameter :: ROTID_STOP_ITERATIONS = 4
  integer(c_int), parameter :: ROTID_STOP_STALLED = 5
  integer(c_int), parameter :: ROTID_STOP_CANCELLED = 6
  integer(c_int), parameter :: ROTID_ERROR_ARGUMENT = -1
  integer(c_int), parameter :: ROTID_ERROR_MEMORY = -2
  integer(c_int), parameter :: ROTID_ERROR_MASS = -3
  integer(c_int), parameter :: ROTID_ERROR_SLAVE = -4
  integer(c_int), parameter :: ROTID_ERROR_STIFFNESS = -5
  integer(c_int), parameter :: ROTID_ERROR_EIGEN = -6
  integer(c_int), parameter :: ROTID_ERROR_CLOSE = -7
  integer(c_int), parameter :: ROTID_ERROR_UNPAIRED = -8
  integer(c_int), parameter :: ROTID_ERROR_RANK = -9
  integer(c_int), parameter :: ROTID_ERROR_CALLBACK = -10
  integer(c_int), parameter :: ROTID_ERROR_FINITE = -11
  integer(c_int), parameter :: ROTID_ERROR_SECTION = -12
  integer(c_int), parameter :: ROTID_ERROR_SYNTAX = -13
  integer(c_int), parameter :: ROTID_ERROR_IO = -14
  integer(c_int), parameter :: ROTID_ERROR_LIBRARY = -15

  ! an integer that is not known
  integer(c_int), parameter :: ROTID_NONE = -2147483647

  ! severity of a message
  integer(c_int), parameter :: ROTID_NOTE = 0
  integer(c_int), parameter :: ROTID_WARNING = 1
  integer(c_int), parameter :: ROTID_ERROR = 2

  ! verdict
  integer(c_int), parameter :: ROTID_ADEQUATE = 0
  integer(c_int), parameter :: ROTID_NAMED = 1
  integer(c_int), parameter :: ROTID_AMBIGUOUS = 2
  integer(c_int), parameter :: ROTID_UNEXPLAINED = 3

  ! functional
  integer(c_int), parameter :: ROTID_LIKELIHOOD = 0
  integer(c_int), parameter :: ROTID_HYBRID = 1
  integer(c_int), parameter :: ROTID_HYBRID_F = 2

  ! reduction
  integer(c_int), parameter :: ROTID_REDUCTION_NONE = 0
  integer(c_int), parameter :: ROTID_GUYAN = 1
  integer(c_int), parameter :: ROTID_IRS = 2

  ! eigenvector derivative
  integer(c_int), parameter :: ROTID_NELSON = 0
  integer(c_int), parameter :: ROTID_MODAL = 1

  ! type of modes
  integer(c_int), parameter :: ROTID_BENDING = 0
  integer(c_int), parameter :: ROTID_TORSION = 1
  integer(c_int), parameter :: ROTID_AXIAL = 2

  ! ------------------------------------------------------------------------------------------------ types: environment

  type, bind(C) :: rotid_allocator
    type(c_funptr) :: allocate = c_null_funptr ! rotid_allocator_allocate
    type(c_funptr) :: release = c_null_funptr  ! rotid_allocator_release
    type(c_ptr) :: context = c_null_ptr
  end type rotid_allocator

  type, bind(C) :: rotid_environment
    integer(c_size_t) :: size = 40
    type(c_ptr) :: allocator = c_null_ptr       ! a rotid_allocator
    type(c_funptr) :: cancelled = c_null_funptr ! rotid_environment_cancelled
    type(c_funptr) :: progress = c_null_funptr  ! rotid_environment_progress
    type(c_ptr) :: context = c_null_ptr
  end type rotid_environment

  ! ------------------------------------------------------------------------------------------------ types: run a deck

  type, bind(C) :: rotid_parameter
    type(c_ptr) :: name = c_null_ptr, unit = c_null_ptr ! texts that end with c_null_char
    real(c_double) :: lower = 0, upper = 0, start = 0
  end type rotid_parameter

  type, bind(C) :: rotid_message
    integer(c_int) :: severity = 0
    integer(c_int) :: line = 0, column = 0
    type(c_ptr) :: file = c_null_ptr
    type(c_ptr) :: text = c_null_ptr
  end type rotid_message

  type, bind(C) :: rotid_reference
    type(c_ptr) :: quantity = c_null_ptr
    integer(c_int) :: nvalues = 0
    type(c_ptr) :: values = c_null_ptr ! real [nvalues]
  end type rotid_reference

  type, bind(C) :: rotid_deck
    type(c_ptr) :: path = c_null_ptr
    integer(c_int) :: nmessage = 0, nerror = 0
    type(c_ptr) :: message = c_null_ptr ! rotid_message [nmessage]
    real(c_double) :: length = 0, mass = 0, centre = 0
    integer(c_int) :: nsensor = 0
    type(c_ptr) :: sensor_id = c_null_ptr     ! integer [nsensor]
    type(c_ptr) :: sensor_z = c_null_ptr      ! real [nsensor]
    integer(c_int) :: nmode = 0
    type(c_ptr) :: number = c_null_ptr        ! integer [nmode]
    type(c_ptr) :: frequency_hz = c_null_ptr  ! real [nmode]
    type(c_ptr) :: frequency_std = c_null_ptr ! real [nmode]
    type(c_ptr) :: shape = c_null_ptr         ! real [nsensor, nmode]
    type(c_ptr) :: shape_std = c_null_ptr     ! real [nsensor, nmode]
    type(c_ptr) :: holdout = c_null_ptr       ! integer [nmode]
    integer(c_int) :: nparameter = 0
    type(c_ptr) :: parameter = c_null_ptr     ! rotid_parameter [nparameter]
    type(c_ptr) :: stated = c_null_ptr        ! real [nparameter]
    integer(c_int) :: nheading = 0, nreferences = 0
    type(c_ptr) :: heading = c_null_ptr       ! type(c_ptr) [nheading]
    type(c_ptr) :: references = c_null_ptr    ! rotid_reference [nreferences]
    type(c_ptr) :: memory = c_null_ptr
    integer(c_int) :: nstate = 0
    type(c_ptr) :: state_name = c_null_ptr    ! type(c_ptr) [nstate]
    type(c_ptr) :: state = c_null_ptr         ! type(c_ptr) [nstate], each of a rotid_deck
  end type rotid_deck

  ! ------------------------------------------------------------------------------------------------ types: results

  type, bind(C) :: rotid_material
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: e_pa = 0
    real(c_double) :: g_pa = 0
    real(c_double) :: nu = 0
    real(c_double) :: rho_kg_m3 = 0
    real(c_double) :: sheet_e_pa = 0
    real(c_double) :: stacking = 0
  end type rotid_material

  type, bind(C) :: rotid_segment
    real(c_double) :: from_m = 0
    real(c_double) :: to_m = 0
    integer(c_int) :: elements = 0
    real(c_double) :: outer_m = 0
    real(c_double) :: inner_m = 0
    real(c_double) :: stiff_outer_m = 0
    real(c_double) :: height_m = 0
    real(c_double) :: width_m = 0
  end type rotid_segment

  type, bind(C) :: rotid_perforation
    integer(c_int) :: number = 0
    real(c_double) :: hole_diameter_m = 0
    real(c_double) :: pitch_radius_m = 0
  end type rotid_perforation

  type, bind(C) :: rotid_group
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: layer_of = c_null_ptr ! text
    real(c_double) :: from_m = 0
    real(c_double) :: to_m = 0
    type(rotid_material) :: material = rotid_material()
    integer(c_int) :: nsegments = 0
    type(c_ptr) :: segments = c_null_ptr ! rotid_segment
    type(c_ptr) :: perforation = c_null_ptr ! rotid_perforation
    real(c_double) :: preload_n = 0
  end type rotid_group

  type, bind(C) :: rotid_tierods
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: from_m = 0
    real(c_double) :: to_m = 0
    type(rotid_material) :: material = rotid_material()
    integer(c_int) :: number = 0
    real(c_double) :: diameter_m = 0
    real(c_double) :: pitch_radius_m = 0
    type(c_ptr) :: model = c_null_ptr ! text
    integer(c_int) :: elements = 0
    real(c_double) :: tension_n = 0
    integer(c_int) :: self_equilibrated = 0
  end type rotid_tierods

  type, bind(C) :: rotid_bars
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: from_m = 0
    real(c_double) :: to_m = 0
    real(c_double) :: center_m = 0
    type(rotid_material) :: material = rotid_material()
    integer(c_int) :: number = 0
    real(c_double) :: diameter_m = 0
    real(c_double) :: pitch_radius_m = 0
    type(c_ptr) :: model = c_null_ptr ! text
    integer(c_int) :: elements = 0
  end type rotid_bars

  type, bind(C) :: rotid_disk
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: z_m = 0
    real(c_double) :: mass_kg = 0
    real(c_double) :: diametral_kg_m2 = 0
    real(c_double) :: polar_kg_m2 = 0
  end type rotid_disk

  type, bind(C) :: rotid_spring
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: z_m = 0
    real(c_double) :: lateral_n_m = 0
    real(c_double) :: rotational_nm_rad = 0
  end type rotid_spring

  type, bind(C) :: rotid_sensor
    integer(c_int) :: id = 0
    real(c_double) :: z_m = 0
  end type rotid_sensor

  type, bind(C) :: rotid_cause_parameter
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: unit = c_null_ptr ! text
    real(c_double) :: value = 0
  end type rotid_cause_parameter

  type, bind(C) :: rotid_model_cause
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: id = c_null_ptr ! text
    type(c_ptr) :: target = c_null_ptr ! text
    integer(c_int) :: sensor = 0
    type(c_ptr) :: variant = c_null_ptr ! text
    integer(c_int) :: nparameters = 0
    type(c_ptr) :: parameters = c_null_ptr ! rotid_cause_parameter
  end type rotid_model_cause

  type, bind(C) :: rotid_geometry
    real(c_double) :: length_m = 0
    integer(c_int) :: ngroups = 0
    type(c_ptr) :: groups = c_null_ptr ! rotid_group
    integer(c_int) :: ntierods = 0
    type(c_ptr) :: tierods = c_null_ptr ! rotid_tierods
    integer(c_int) :: nbars = 0
    type(c_ptr) :: bars = c_null_ptr ! rotid_bars
    integer(c_int) :: ndisks = 0
    type(c_ptr) :: disks = c_null_ptr ! rotid_disk
    integer(c_int) :: nsprings = 0
    type(c_ptr) :: springs = c_null_ptr ! rotid_spring
    real(c_double) :: sling_m = 0
    integer(c_int) :: nsensors = 0
    type(c_ptr) :: sensors = c_null_ptr ! rotid_sensor
    integer(c_int) :: ncauses = 0
    type(c_ptr) :: causes = c_null_ptr ! rotid_model_cause
    integer(c_int) :: nnodes_z_m = 0
    type(c_ptr) :: nodes_z_m = c_null_ptr ! real
  end type rotid_geometry

  type, bind(C) :: rotid_fitted_parameter
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: unit = c_null_ptr ! text
    real(c_double) :: value = 0
    real(c_double) :: start = 0
    real(c_double) :: lower = 0
    real(c_double) :: upper = 0
    real(c_double) :: std = 0
    real(c_double) :: ci95(2) = 0
    integer(c_int) :: at_bound = 0
    integer(c_int) :: identifiable = 0
  end type rotid_fitted_parameter

  type, bind(C) :: rotid_compared_mode
    integer(c_int) :: mode = 0
    integer(c_int) :: measured_mode = 0
    real(c_double) :: measured_hz = 0
    real(c_double) :: frequency_std = 0
    real(c_double) :: predicted_hz = 0
    real(c_double) :: error_percent = 0
    real(c_double) :: mac = 0
    real(c_double) :: nco = 0
    type(c_ptr) :: paired_by = c_null_ptr ! text
    integer(c_int) :: holdout = 0
    real(c_double) :: residual = 0
    type(c_ptr) :: type = c_null_ptr ! text
  end type rotid_compared_mode

  type, bind(C) :: rotid_member_shape
    type(c_ptr) :: name = c_null_ptr ! text
    integer(c_int) :: nz_m = 0
    type(c_ptr) :: z_m = c_null_ptr ! real
    type(c_ptr) :: shape = c_null_ptr ! real
  end type rotid_member_shape

  type, bind(C) :: rotid_mode_shapes
    integer(c_int) :: mode = 0
    integer(c_int) :: measured_mode = 0
    integer(c_int) :: nmeasured = 0
    integer(c_int) :: nmeasured_std = 0
    integer(c_int) :: npredicted = 0
    integer(c_int) :: npredicted_axis = 0
    type(c_ptr) :: measured = c_null_ptr ! real
    type(c_ptr) :: measured_std = c_null_ptr ! real
    type(c_ptr) :: predicted = c_null_ptr ! real
    type(c_ptr) :: predicted_axis = c_null_ptr ! real
    integer(c_int) :: ntierods = 0
    type(c_ptr) :: tierods = c_null_ptr ! rotid_member_shape
    integer(c_int) :: nbars = 0
    type(c_ptr) :: bars = c_null_ptr ! rotid_member_shape
  end type rotid_mode_shapes

  type, bind(C) :: rotid_shapes
    integer(c_int) :: nsensor_id = 0
    type(c_ptr) :: sensor_id = c_null_ptr ! integer
    type(c_ptr) :: z_m = c_null_ptr ! real
    integer(c_int) :: naxis_z_m = 0
    type(c_ptr) :: axis_z_m = c_null_ptr ! real
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! rotid_mode_shapes
  end type rotid_shapes

  type, bind(C) :: rotid_history_entry
    integer(c_int) :: iteration = 0
    real(c_double) :: objective = 0
    real(c_double) :: gradient = 0
    real(c_double) :: mu = 0
    real(c_double) :: gain_ratio = 0
    real(c_double) :: step = 0
    real(c_double) :: seconds = 0
    integer(c_int) :: nx = 0
    type(c_ptr) :: x = c_null_ptr ! real
  end type rotid_history_entry

  type, bind(C) :: rotid_minimiser
    type(c_ptr) :: algorithm = c_null_ptr ! text
    type(c_ptr) :: result = c_null_ptr ! text
    integer(c_int) :: usable = 0
    real(c_double) :: objective = 0
    real(c_double) :: gradient = 0
    integer(c_int) :: evaluations = 0
    real(c_double) :: seconds = 0
    integer(c_int) :: nx = 0
    integer(c_int) :: npredicted_hz = 0
    type(c_ptr) :: x = c_null_ptr ! real
    type(c_ptr) :: predicted_hz = c_null_ptr ! real
  end type rotid_minimiser

  type, bind(C) :: rotid_noise
    real(c_double) :: frequency = 0
    real(c_double) :: shape = 0
    integer(c_int) :: frequency_assumed = 0
    integer(c_int) :: shape_assumed = 0
    type(c_ptr) :: intervals_from = c_null_ptr ! text
  end type rotid_noise

  type, bind(C) :: rotid_component
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: value = 0
  end type rotid_component

  type, bind(C) :: rotid_identified_state
    type(c_ptr) :: name = c_null_ptr ! text
    integer(c_int) :: fitted_residuals = 0
    integer(c_int) :: shapes_fitted = 0
    real(c_double) :: objective = 0
    real(c_double) :: chi2 = 0
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! rotid_compared_mode
    type(c_ptr) :: reduction_error_percent = c_null_ptr ! real
    type(c_ptr) :: mesh_error_percent = c_null_ptr ! real
    real(c_double) :: mass_kg = 0
    real(c_double) :: center_of_mass_m = 0
    type(c_ptr) :: shapes = c_null_ptr ! rotid_shapes
    integer(c_int) :: nmatrix_rows = 0
    integer(c_int) :: nmatrix_columns = 0
    type(c_ptr) :: nco_matrix = c_null_ptr ! real
    type(c_ptr) :: mac_matrix = c_null_ptr ! real
    type(c_ptr) :: matrix_rows = c_null_ptr ! integer
    type(c_ptr) :: matrix_columns = c_null_ptr ! integer
    type(c_ptr) :: noise = c_null_ptr ! rotid_noise
    type(c_ptr) :: geometry = c_null_ptr ! rotid_geometry
  end type rotid_identified_state

  type, bind(C) :: rotid_hidden
    type(c_ptr) :: parameter = c_null_ptr ! text
    real(c_double) :: shift = 0
    type(c_ptr) :: unit = c_null_ptr ! text
    type(c_ptr) :: id = c_null_ptr ! text
    type(c_ptr) :: target = c_null_ptr ! text
    type(c_ptr) :: component = c_null_ptr ! text
    real(c_double) :: size = 0
    type(c_ptr) :: size_unit = c_null_ptr ! text
    real(c_double) :: z_m = 0
    real(c_double) :: width_m = 0
    integer(c_int) :: beyond = 0
  end type rotid_hidden

  type, bind(C) :: rotid_runup_speed
    integer(c_int) :: number = 0
    type(c_ptr) :: whirl = c_null_ptr ! text
    real(c_double) :: measured_rpm = 0
    real(c_double) :: measured_std = 0
    real(c_double) :: predicted_rpm = 0
    real(c_double) :: predicted_std = 0
    real(c_double) :: z = 0
    integer(c_int) :: holdout = 0
  end type rotid_runup_speed

  type, bind(C) :: rotid_weighed
    type(c_ptr) :: quantity = c_null_ptr ! text
    type(c_ptr) :: unit = c_null_ptr ! text
    type(c_ptr) :: state = c_null_ptr ! text
    real(c_double) :: measured = 0
    real(c_double) :: std = 0
    real(c_double) :: predicted = 0
    real(c_double) :: z = 0
  end type rotid_weighed

  type, bind(C) :: rotid_identification
    type(c_ptr) :: status = c_null_ptr ! text
    type(c_ptr) :: functional = c_null_ptr ! text
    type(c_ptr) :: reduction = c_null_ptr ! text
    type(c_ptr) :: derivative = c_null_ptr ! text
    integer(c_int) :: shapes_fitted = 0
    real(c_double) :: bijection_chi = 0
    real(c_double) :: objective = 0
    real(c_double) :: gradient = 0
    real(c_double) :: chi2 = 0
    real(c_double) :: chi2_per_dof = 0
    integer(c_int) :: dof = 0
    integer(c_int) :: iterations = 0
    integer(c_int) :: evaluations = 0
    integer(c_int) :: jacobians = 0
    type(c_ptr) :: stop_reason = c_null_ptr ! text
    integer(c_int) :: nparameters = 0
    type(c_ptr) :: parameters = c_null_ptr ! rotid_fitted_parameter
    type(c_ptr) :: correlation = c_null_ptr ! real
    real(c_double) :: condition_number = 0
    integer(c_int) :: nundetermined_directions = 0
    type(c_ptr) :: undetermined_directions = c_null_ptr ! rotid_component
    real(c_double) :: intervals_widened_by = 0
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! rotid_compared_mode
    type(c_ptr) :: reduction_error_percent = c_null_ptr ! real
    type(c_ptr) :: mesh_error_percent = c_null_ptr ! real
    real(c_double) :: mass_kg = 0
    real(c_double) :: center_of_mass_m = 0
    type(c_ptr) :: shapes = c_null_ptr ! rotid_shapes
    integer(c_int) :: nmatrix_rows = 0
    integer(c_int) :: nmatrix_columns = 0
    type(c_ptr) :: nco_matrix = c_null_ptr ! real
    type(c_ptr) :: mac_matrix = c_null_ptr ! real
    type(c_ptr) :: matrix_rows = c_null_ptr ! integer
    type(c_ptr) :: matrix_columns = c_null_ptr ! integer
    integer(c_int) :: nhistory = 0
    type(c_ptr) :: history = c_null_ptr ! rotid_history_entry
    integer(c_int) :: nlopt = 0
    integer(c_int) :: nbaseline = 0
    type(c_ptr) :: baseline = c_null_ptr ! rotid_minimiser
    real(c_double) :: seconds = 0
    type(c_ptr) :: noise = c_null_ptr ! rotid_noise
    type(c_ptr) :: geometry = c_null_ptr ! rotid_geometry
    integer(c_int) :: nmessage = 0
    type(c_ptr) :: message = c_null_ptr ! rotid_message
    type(c_ptr) :: fit = c_null_ptr ! rotid_fit_result
    type(c_ptr) :: memory = c_null_ptr
    integer(c_int) :: nstates = 0
    type(c_ptr) :: states = c_null_ptr ! rotid_identified_state
    integer(c_int) :: nhidden = 0
    type(c_ptr) :: hidden = c_null_ptr ! rotid_hidden
    integer(c_int) :: nrunup = 0
    type(c_ptr) :: runup = c_null_ptr ! rotid_runup_speed
    integer(c_int) :: nweighed = 0
    type(c_ptr) :: weighed = c_null_ptr ! rotid_weighed
  end type rotid_identification

  type, bind(C) :: rotid_meridian_mode
    integer(c_int) :: nu = 0
    type(c_ptr) :: u = c_null_ptr ! real
    integer(c_int) :: nw = 0
    type(c_ptr) :: w = c_null_ptr ! real
    integer(c_int) :: nenergy = 0
    type(c_ptr) :: energy = c_null_ptr ! real
  end type rotid_meridian_mode

  type, bind(C) :: rotid_model_mode
    integer(c_int) :: mode = 0
    real(c_double) :: full_hz = 0
    real(c_double) :: reduced_hz = 0
    real(c_double) :: reduction_error_percent = 0
    real(c_double) :: mesh_error_percent = 0
    integer(c_int) :: nshape = 0
    type(c_ptr) :: shape = c_null_ptr ! real
    type(c_ptr) :: measured = c_null_ptr ! rotid_compared_mode
    type(c_ptr) :: meridian = c_null_ptr ! rotid_meridian_mode
  end type rotid_model_mode

  type, bind(C) :: rotid_meridian_element
    integer(c_int) :: group = 0
    integer(c_int) :: corner(4) = 0
  end type rotid_meridian_element

  type, bind(C) :: rotid_meridian
    integer(c_int) :: nr_m = 0
    type(c_ptr) :: r_m = c_null_ptr ! real
    type(c_ptr) :: z_m = c_null_ptr ! real
    integer(c_int) :: nelements = 0
    type(c_ptr) :: elements = c_null_ptr ! rotid_meridian_element
  end type rotid_meridian

  type, bind(C) :: rotid_beside_mode
    integer(c_int) :: mode = 0
    integer(c_int) :: beam_mode = 0
    real(c_double) :: solid_hz = 0
    real(c_double) :: beam_hz = 0
    real(c_double) :: difference_percent = 0
    real(c_double) :: nco = 0
    real(c_double) :: mac = 0
    real(c_double) :: solid_mesh_error_percent = 0
    real(c_double) :: beam_mesh_error_percent = 0
  end type rotid_beside_mode

  type, bind(C) :: rotid_beside_modulus
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: stated_pa = 0
    real(c_double) :: found_pa = 0
    real(c_double) :: change_percent = 0
  end type rotid_beside_modulus

  type, bind(C) :: rotid_beam_beside_solid
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! rotid_beside_mode
    integer(c_int) :: nmoduli = 0
    type(c_ptr) :: moduli = c_null_ptr ! rotid_beside_modulus
    integer(c_int) :: nfitted_modes = 0
    type(c_ptr) :: fitted_modes = c_null_ptr ! integer
    real(c_double) :: fitted_rms_percent = 0
    type(c_ptr) :: sentence = c_null_ptr ! text
  end type rotid_beam_beside_solid

  type, bind(C) :: rotid_spectrum
    type(c_ptr) :: reduction = c_null_ptr ! text
    integer(c_int) :: nrigid_hz = 0
    type(c_ptr) :: rigid_hz = c_null_ptr ! real
    integer(c_int) :: nsensor_z_m = 0
    type(c_ptr) :: sensor_z_m = c_null_ptr ! real
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! rotid_model_mode
    type(c_ptr) :: geometry = c_null_ptr ! rotid_geometry
    type(c_ptr) :: meridian = c_null_ptr ! rotid_meridian
    type(c_ptr) :: beside = c_null_ptr ! rotid_beam_beside_solid
    type(c_ptr) :: master_mass = c_null_ptr ! real
    integer(c_int) :: nmessage = 0
    type(c_ptr) :: message = c_null_ptr ! rotid_message
    type(c_ptr) :: type = c_null_ptr ! text
    type(c_ptr) :: memory = c_null_ptr
  end type rotid_spectrum

  type, bind(C) :: rotid_solid_mesh
    integer(c_int) :: unknowns = 0
    integer(c_int) :: half_band = 0
    integer(c_int) :: slices = 0
    real(c_double) :: corner_m = 0
    real(c_double) :: largest_m = 0
  end type rotid_solid_mesh

  type, bind(C) :: rotid_check
    real(c_double) :: length_m = 0
    real(c_double) :: mass_kg = 0
    real(c_double) :: center_of_mass_m = 0
    real(c_double) :: inertia_kg_m2 = 0
    integer(c_int) :: nodes = 0
    integer(c_int) :: elements = 0
    type(c_ptr) :: solid = c_null_ptr ! rotid_solid_mesh
    integer(c_int) :: rigid_modes = 0
    integer(c_int) :: nrigid_hz = 0
    type(c_ptr) :: rigid_hz = c_null_ptr ! real
    integer(c_int) :: measured_modes = 0
    type(c_ptr) :: functional = c_null_ptr ! text
    type(c_ptr) :: reduction = c_null_ptr ! text
    integer(c_int) :: nsensors = 0
    type(c_ptr) :: sensors = c_null_ptr ! rotid_sensor
    integer(c_int) :: nparameters = 0
    type(c_ptr) :: parameters = c_null_ptr ! texts
    type(c_ptr) :: geometry = c_null_ptr ! rotid_geometry
    type(c_ptr) :: memory = c_null_ptr
    integer(c_int) :: nweighed = 0
    type(c_ptr) :: weighed = c_null_ptr ! rotid_weighed
  end type rotid_check

  type, bind(C) :: rotid_cause_value
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: unit = c_null_ptr ! text
    real(c_double) :: value = 0
    real(c_double) :: std = 0
    real(c_double) :: ci95(2) = 0
    integer(c_int) :: fixed = 0
  end type rotid_cause_value

  type, bind(C) :: rotid_cause
    type(c_ptr) :: id = c_null_ptr ! text
    type(c_ptr) :: target = c_null_ptr ! text
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: variant = c_null_ptr ! text
    integer(c_int) :: nparameters = 0
    type(c_ptr) :: parameters = c_null_ptr ! rotid_cause_value
    type(c_ptr) :: state = c_null_ptr ! text
  end type rotid_cause

  type, bind(C) :: rotid_spread
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: unit = c_null_ptr ! text
    real(c_double) :: lowest = 0
    real(c_double) :: highest = 0
    real(c_double) :: ci95(2) = 0
  end type rotid_spread

  type, bind(C) :: rotid_explanation
    integer(c_int) :: ncauses = 0
    type(c_ptr) :: causes = c_null_ptr ! rotid_cause
    integer(c_int) :: something_else = 0
    real(c_double) :: probability = 0
    real(c_double) :: at_rest = 0
    integer(c_int) :: nidentified = 0
    type(c_ptr) :: identified = c_null_ptr ! rotid_cause_value
  end type rotid_explanation

  type, bind(C) :: rotid_marginal
    type(c_ptr) :: id = c_null_ptr ! text
    type(c_ptr) :: target = c_null_ptr ! text
    type(c_ptr) :: state = c_null_ptr ! text
    real(c_double) :: z_m = 0
    real(c_double) :: probability = 0
  end type rotid_marginal

  type, bind(C) :: rotid_averaged_parameter
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: unit = c_null_ptr ! text
    real(c_double) :: value = 0
    real(c_double) :: std = 0
    real(c_double) :: ci95(2) = 0
  end type rotid_averaged_parameter

  type, bind(C) :: rotid_verdict
    integer(c_int) :: kind = 0
    integer(c_int) :: adequate_after = 0
    real(c_double) :: p_value = 0
    integer(c_int) :: ncauses = 0
    type(c_ptr) :: causes = c_null_ptr ! rotid_cause
    integer(c_int) :: nlikely_causes = 0
    type(c_ptr) :: likely_causes = c_null_ptr ! rotid_cause
    integer(c_int) :: nalternatives = 0
    type(c_ptr) :: alternatives = c_null_ptr ! texts
    integer(c_int) :: nalternative_causes = 0
    type(c_ptr) :: alternative_causes = c_null_ptr ! rotid_cause
    integer(c_int) :: nalternative_sets = 0
    type(c_ptr) :: alternative_sets = c_null_ptr ! integer
    type(c_ptr) :: next_measurement = c_null_ptr ! text
    type(c_ptr) :: sentence = c_null_ptr ! text
    integer(c_int) :: undetermined_parameters = 0
    integer(c_int) :: confident = 0
    integer(c_int) :: nspread = 0
    type(c_ptr) :: spread = c_null_ptr ! rotid_spread
    integer(c_int) :: nexplanations = 0
    type(c_ptr) :: explanations = c_null_ptr ! rotid_explanation
    integer(c_int) :: nmarginals = 0
    type(c_ptr) :: marginals = c_null_ptr ! rotid_marginal
    real(c_double) :: nothing = 0
    real(c_double) :: nothing_prior = 0
    real(c_double) :: something_else = 0
    real(c_double) :: runup_p = 0
  end type rotid_verdict

  type, bind(C) :: rotid_data_finding
    type(c_ptr) :: id = c_null_ptr ! text
    integer(c_int) :: nsensors = 0
    type(c_ptr) :: sensors = c_null_ptr ! integer
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! integer
    type(c_ptr) :: block = c_null_ptr ! text
    real(c_double) :: value = 0
    type(c_ptr) :: unit = c_null_ptr ! text
    real(c_double) :: std = 0
    real(c_double) :: chi2_drop = 0
    type(c_ptr) :: text = c_null_ptr ! text
    type(c_ptr) :: state = c_null_ptr ! text
    integer(c_int) :: nparameters = 0
    type(c_ptr) :: parameters = c_null_ptr ! rotid_cause_value
  end type rotid_data_finding

  type, bind(C) :: rotid_numerical_finding
    type(c_ptr) :: id = c_null_ptr ! text
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! integer
    type(c_ptr) :: error_percent = c_null_ptr ! real
    type(c_ptr) :: text = c_null_ptr ! text
    type(c_ptr) :: state = c_null_ptr ! text
  end type rotid_numerical_finding

  type, bind(C) :: rotid_round
    integer(c_int) :: round = 0
    real(c_double) :: chi2 = 0
    real(c_double) :: chi2_frequency = 0
    integer(c_int) :: dof = 0
    integer(c_int) :: frequencies = 0
    real(c_double) :: largest = 0
    real(c_double) :: p_frequency = 0
    real(c_double) :: p_total = 0
  end type rotid_round

  type, bind(C) :: rotid_candidate
    integer(c_int) :: round = 0
    type(rotid_cause) :: cause = rotid_cause()
    integer(c_int) :: suspect = 0
    integer(c_int) :: refitted = 0
    real(c_double) :: predicted_drop = 0
    real(c_double) :: chi2 = 0
    real(c_double) :: chi2_frequency = 0
    real(c_double) :: chi2_drop = 0
    real(c_double) :: holdout_rms = 0
    real(c_double) :: sensor_out_rms = 0
    integer(c_int) :: at_bound = 0
    real(c_double) :: probability = 0
  end type rotid_candidate

  type, bind(C) :: rotid_pair
    real(c_double) :: before = 0
    real(c_double) :: after = 0
  end type rotid_pair

  type, bind(C) :: rotid_changed_parameter
    type(c_ptr) :: name = c_null_ptr ! text
    type(c_ptr) :: unit = c_null_ptr ! text
    real(c_double) :: before = 0
    real(c_double) :: after = 0
    real(c_double) :: before_ci95(2) = 0
    real(c_double) :: after_ci95(2) = 0
  end type rotid_changed_parameter

  type, bind(C) :: rotid_gain
    type(rotid_pair) :: frequency_rms_percent = rotid_pair()
    type(rotid_pair) :: frequency_max_percent = rotid_pair()
    type(rotid_pair) :: shape_rms = rotid_pair()
    type(rotid_pair) :: chi2_per_dof = rotid_pair()
    type(rotid_pair) :: nco_min = rotid_pair()
    type(rotid_pair) :: holdout_frequency_rms_percent = rotid_pair()
    type(rotid_pair) :: holdout_shape_rms = rotid_pair()
    type(rotid_pair) :: mode_out_frequency_rms_percent = rotid_pair()
    type(rotid_pair) :: mode_out_shape_rms = rotid_pair()
    type(rotid_pair) :: sensor_out_shape_rms = rotid_pair()
    integer(c_int) :: nparameters = 0
    type(c_ptr) :: parameters = c_null_ptr ! rotid_changed_parameter
  end type rotid_gain

  type, bind(C) :: rotid_sensor_residual
    integer(c_int) :: id = 0
    real(c_double) :: z_m = 0
    real(c_double) :: rms = 0
    type(c_ptr) :: state = c_null_ptr ! text
  end type rotid_sensor_residual

  type, bind(C) :: rotid_localisation
    real(c_double) :: z_m = 0
    real(c_double) :: indicator = 0
  end type rotid_localisation

  type, bind(C) :: rotid_detectable
    type(c_ptr) :: id = c_null_ptr ! text
    type(c_ptr) :: target = c_null_ptr ! text
    type(c_ptr) :: parameter = c_null_ptr ! text
    real(c_double) :: smallest = 0
    type(c_ptr) :: unit = c_null_ptr ! text
    real(c_double) :: z_m = 0
    real(c_double) :: worst = 0
    integer(c_int) :: beyond = 0
  end type rotid_detectable

  type, bind(C) :: rotid_step
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: seconds = 0
  end type rotid_step

  type, bind(C) :: rotid_diagnosis
    integer(c_int) :: interrupted = 0
    type(rotid_verdict) :: verdict = rotid_verdict()
    integer(c_int) :: ndata_findings = 0
    type(c_ptr) :: data_findings = c_null_ptr ! rotid_data_finding
    integer(c_int) :: nnumerical_findings = 0
    type(c_ptr) :: numerical_findings = c_null_ptr ! rotid_numerical_finding
    integer(c_int) :: nrounds = 0
    type(c_ptr) :: rounds = c_null_ptr ! rotid_round
    integer(c_int) :: ncandidates = 0
    type(c_ptr) :: candidates = c_null_ptr ! rotid_candidate
    type(rotid_gain) :: gain = rotid_gain()
    integer(c_int) :: nmodes_standardised = 0
    type(c_ptr) :: modes_standardised = c_null_ptr ! real
    integer(c_int) :: nsensors = 0
    type(c_ptr) :: sensors = c_null_ptr ! rotid_sensor_residual
    integer(c_int) :: nlocalisation = 0
    type(c_ptr) :: localisation = c_null_ptr ! rotid_localisation
    integer(c_int) :: ndetectable = 0
    type(c_ptr) :: detectable = c_null_ptr ! rotid_detectable
    type(rotid_noise) :: noise = rotid_noise()
    type(c_ptr) :: geometry = c_null_ptr ! rotid_geometry
    type(c_ptr) :: today = c_null_ptr ! rotid_identification
    type(c_ptr) :: base = c_null_ptr ! rotid_identification
    type(c_ptr) :: extended = c_null_ptr ! rotid_identification
    integer(c_int) :: nsteps = 0
    type(c_ptr) :: steps = c_null_ptr ! rotid_step
    integer(c_int) :: nmessage = 0
    type(c_ptr) :: message = c_null_ptr ! rotid_message
    type(c_ptr) :: extended_deck = c_null_ptr ! text
    type(c_ptr) :: memory = c_null_ptr
    type(c_ptr) :: before = c_null_ptr ! text
    type(c_ptr) :: after = c_null_ptr ! text
    integer(c_int) :: nhidden = 0
    type(c_ptr) :: hidden = c_null_ptr ! rotid_hidden
    integer(c_int) :: nparameters = 0
    type(c_ptr) :: parameters = c_null_ptr ! rotid_averaged_parameter
  end type rotid_diagnosis

  type, bind(C) :: rotid_expected_modes
    integer(c_int) :: modes = 0
    integer(c_int) :: nfrequencies_percent = 0
    integer(c_int) :: nshapes_percent = 0
    type(c_ptr) :: frequencies_percent = c_null_ptr ! real
    type(c_ptr) :: shapes_percent = c_null_ptr ! real
  end type rotid_expected_modes

  type, bind(C) :: rotid_sensor_plan
    type(c_ptr) :: method = c_null_ptr ! text
    integer(c_int) :: nz_m = 0
    integer(c_int) :: nloss_percent = 0
    integer(c_int) :: nhalf_width_percent = 0
    type(c_ptr) :: z_m = c_null_ptr ! real
    type(c_ptr) :: loss_percent = c_null_ptr ! real
    type(c_ptr) :: half_width_percent = c_null_ptr ! real
    real(c_double) :: gain_percent = 0
  end type rotid_sensor_plan

  type, bind(C) :: rotid_sensor_count
    integer(c_int) :: sensors = 0
    real(c_double) :: half_width_percent = 0
    real(c_double) :: gain_percent = 0
  end type rotid_sensor_count

  type, bind(C) :: rotid_sensor_place
    real(c_double) :: z_m = 0
    real(c_double) :: worth_percent = 0
    real(c_double) :: margin_percent = 0
  end type rotid_sensor_place

  type, bind(C) :: rotid_rival
    type(c_ptr) :: label = c_null_ptr ! text
    integer(c_int) :: ncauses = 0
    type(c_ptr) :: causes = c_null_ptr ! rotid_cause
    real(c_double) :: chi2 = 0
    real(c_double) :: score = 0
    real(c_double) :: share = 0
  end type rotid_rival

  type, bind(C) :: rotid_expected_margin
    integer(c_int) :: truth = 0
    integer(c_int) :: rival = 0
    real(c_double) :: before = 0
    real(c_double) :: distance = 0
    real(c_double) :: expected = 0
    real(c_double) :: refitted = 0
    real(c_double) :: chance = 0
  end type rotid_expected_margin

  type, bind(C) :: rotid_suggested_test
    type(c_ptr) :: id = c_null_ptr ! text
    type(c_ptr) :: text = c_null_ptr ! text
    real(c_double) :: cost = 0
    integer(c_int) :: setups = 0
    integer(c_int) :: points = 0
    integer(c_int) :: modes = 0
    integer(c_int) :: nsensors_m = 0
    type(c_ptr) :: sensors_m = c_null_ptr ! real
    real(c_double) :: mass_kg = 0
    real(c_double) :: z_m = 0
    real(c_double) :: chance = 0
    real(c_double) :: wrong = 0
    real(c_double) :: entropy = 0
    integer(c_int) :: nexpected_percent = 0
    type(c_ptr) :: expected_percent = c_null_ptr ! real
    integer(c_int) :: nmargins = 0
    type(c_ptr) :: margins = c_null_ptr ! rotid_expected_margin
    type(c_ptr) :: cards = c_null_ptr ! text
  end type rotid_suggested_test

  type, bind(C) :: rotid_speed_test
    type(c_ptr) :: test = c_null_ptr ! text
    integer(c_int) :: modes = 0
    real(c_double) :: std_rpm = 0
    real(c_double) :: narrowed_percent = 0
  end type rotid_speed_test

  type, bind(C) :: rotid_suggestion
    integer(c_int) :: nparameters = 0
    type(c_ptr) :: parameters = c_null_ptr ! rotid_fitted_parameter
    type(rotid_noise) :: noise = rotid_noise()
    real(c_double) :: wanted_percent = 0
    integer(c_int) :: modes_needed = 0
    integer(c_int) :: sensors_needed = 0
    integer(c_int) :: plan_modes = 0
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! rotid_expected_modes
    integer(c_int) :: nplans = 0
    type(c_ptr) :: plans = c_null_ptr ! rotid_sensor_plan
    integer(c_int) :: ncounts = 0
    type(c_ptr) :: counts = c_null_ptr ! rotid_sensor_count
    integer(c_int) :: nplaces = 0
    type(c_ptr) :: places = c_null_ptr ! rotid_sensor_place
    integer(c_int) :: ndetectable = 0
    type(c_ptr) :: detectable = c_null_ptr ! rotid_detectable
    type(c_ptr) :: verdict = c_null_ptr ! text
    integer(c_int) :: nrivals = 0
    type(c_ptr) :: rivals = c_null_ptr ! rotid_rival
    real(c_double) :: among = 0
    real(c_double) :: entropy = 0
    integer(c_int) :: ntests = 0
    type(c_ptr) :: tests = c_null_ptr ! rotid_suggested_test
    real(c_double) :: set_up_cost = 0
    type(c_ptr) :: state = c_null_ptr ! text
    type(c_ptr) :: sentence = c_null_ptr ! text
    type(c_ptr) :: geometry = c_null_ptr ! rotid_geometry
    integer(c_int) :: nmessage = 0
    type(c_ptr) :: message = c_null_ptr ! rotid_message
    type(c_ptr) :: memory = c_null_ptr
    real(c_double) :: speed_rpm = 0
    real(c_double) :: speed_std = 0
    real(c_double) :: speed_identified = 0
    integer(c_int) :: nspeed_tests = 0
    type(c_ptr) :: speed_tests = c_null_ptr ! rotid_speed_test
  end type rotid_suggestion

  type, bind(C) :: rotid_speed_margin
    real(c_double) :: value = 0
    real(c_double) :: ci95(2) = 0
    real(c_double) :: required = 0
    real(c_double) :: probability = 0
  end type rotid_speed_margin

  type, bind(C) :: rotid_response_peak
    type(c_ptr) :: probe = c_null_ptr ! text
    real(c_double) :: speed_rpm = 0
    real(c_double) :: amplitude_m = 0
    real(c_double) :: amplification = 0
  end type rotid_response_peak

  type, bind(C) :: rotid_variance_share
    type(c_ptr) :: source = c_null_ptr ! text
    real(c_double) :: share = 0
  end type rotid_variance_share

  type, bind(C) :: rotid_speed_sensitivity
    type(c_ptr) :: parameter = c_null_ptr ! text
    real(c_double) :: speed = 0
    real(c_double) :: log_decrement = 0
    real(c_double) :: amplitude = 0
  end type rotid_speed_sensitivity

  type, bind(C) :: rotid_critical_speed
    integer(c_int) :: number = 0
    integer(c_int) :: mode = 0
    real(c_double) :: speed_rpm = 0
    real(c_double) :: std = 0
    real(c_double) :: ci95(2) = 0
    type(c_ptr) :: whirl = c_null_ptr ! text
    real(c_double) :: log_decrement = 0
    real(c_double) :: log_decrement_ci95(2) = 0
    real(c_double) :: damping_ratio = 0
    real(c_double) :: amplification = 0
    type(rotid_speed_margin) :: margin = rotid_speed_margin()
    integer(c_int) :: npeaks = 0
    type(c_ptr) :: peaks = c_null_ptr ! rotid_response_peak
    integer(c_int) :: nvariance_shares = 0
    type(c_ptr) :: variance_shares = c_null_ptr ! rotid_variance_share
    integer(c_int) :: nsensitivities = 0
    type(c_ptr) :: sensitivities = c_null_ptr ! rotid_speed_sensitivity
    integer(c_int) :: nz = 0
    type(c_ptr) :: z = c_null_ptr ! real
    type(c_ptr) :: x_re = c_null_ptr ! real
    type(c_ptr) :: x_im = c_null_ptr ! real
    type(c_ptr) :: y_re = c_null_ptr ! real
    type(c_ptr) :: y_im = c_null_ptr ! real
  end type rotid_critical_speed

  type, bind(C) :: rotid_campbell_mode
    integer(c_int) :: mode = 0
    real(c_double) :: frequency_hz = 0
    real(c_double) :: ci95(2) = 0
    real(c_double) :: damping_ratio = 0
    real(c_double) :: log_decrement = 0
    real(c_double) :: log_decrement_ci95(2) = 0
    type(c_ptr) :: whirl = c_null_ptr ! text
  end type rotid_campbell_mode

  type, bind(C) :: rotid_campbell_speed
    real(c_double) :: speed_rpm = 0
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr ! rotid_campbell_mode
  end type rotid_campbell_speed

  type, bind(C) :: rotid_stability
    real(c_double) :: onset_rpm = 0
    integer(c_int) :: mode = 0
    real(c_double) :: probability_stable = 0
  end type rotid_stability

  type, bind(C) :: rotid_probe_response
    type(c_ptr) :: probe = c_null_ptr ! text
    integer(c_int) :: nspeed_rpm = 0
    type(c_ptr) :: speed_rpm = c_null_ptr ! real
    type(c_ptr) :: amplitude_m = c_null_ptr ! real
    type(c_ptr) :: phase_deg = c_null_ptr ! real
    type(c_ptr) :: from_m = c_null_ptr ! real
    type(c_ptr) :: to_m = c_null_ptr ! real
  end type rotid_probe_response

  type, bind(C) :: rotid_bearing_load
    type(c_ptr) :: bearing = c_null_ptr ! text
    real(c_double) :: position_m = 0
    real(c_double) :: load_x_n = 0
    real(c_double) :: load_y_n = 0
  end type rotid_bearing_load

  type, bind(C) :: rotid_map_row
    real(c_double) :: stiffness_factor = 0
    integer(c_int) :: nspeed_rpm = 0
    type(c_ptr) :: speed_rpm = c_null_ptr ! real
    type(c_ptr) :: from_rpm = c_null_ptr ! real
    type(c_ptr) :: to_rpm = c_null_ptr ! real
  end type rotid_map_row

  type, bind(C) :: rotid_excitation
    type(c_ptr) :: name = c_null_ptr ! text
    real(c_double) :: per_revolution = 0
    real(c_double) :: hz = 0
  end type rotid_excitation

  type, bind(C) :: rotid_torsional_frequency
    integer(c_int) :: number = 0
    real(c_double) :: frequency_hz = 0
    real(c_double) :: std_hz = 0
  end type rotid_torsional_frequency

  type, bind(C) :: rotid_speeds
    real(c_double) :: low_rpm = 0
    real(c_double) :: high_rpm = 0
    real(c_double) :: harmonic = 0
    integer(c_int) :: draws = 0
    real(c_double) :: basis_error = 0
    integer(c_int) :: ncritical_speeds = 0
    type(c_ptr) :: critical_speeds = c_null_ptr ! rotid_critical_speed
    type(rotid_stability) :: stability = rotid_stability()
    integer(c_int) :: ncampbell = 0
    type(c_ptr) :: campbell = c_null_ptr ! rotid_campbell_speed
    integer(c_int) :: nexcitation = 0
    type(c_ptr) :: excitation = c_null_ptr ! rotid_excitation
    integer(c_int) :: nunbalance = 0
    type(c_ptr) :: unbalance = c_null_ptr ! rotid_probe_response
    real(c_double) :: weight_n = 0
    real(c_double) :: sag_m = 0
    integer(c_int) :: nbearing_loads = 0
    type(c_ptr) :: bearing_loads = c_null_ptr ! rotid_bearing_load
    integer(c_int) :: nmap = 0
    type(c_ptr) :: map = c_null_ptr ! rotid_map_row
    integer(c_int) :: nrunup = 0
    type(c_ptr) :: runup = c_null_ptr ! rotid_runup_speed
    integer(c_int) :: ntorsion = 0
    type(c_ptr) :: torsion = c_null_ptr ! rotid_torsional_frequency
    integer(c_int) :: nmessage = 0
    type(c_ptr) :: message = c_null_ptr ! rotid_message
    type(c_ptr) :: memory = c_null_ptr
  end type rotid_speeds

  ! ---- types: end of results

  type, bind(C) :: rotid_diagnose_options
    integer(c_size_t) :: size = 32
    integer(c_int) :: threads = 0
    type(c_ptr) :: before = c_null_ptr ! text
    type(c_ptr) :: after = c_null_ptr ! text
  end type rotid_diagnose_options

  type, bind(C) :: rotid_suggest_options
    integer(c_size_t) :: size = 72
    real(c_double) :: wanted_percent = 0, frequency_noise = 0, shape_noise = 0, set_up_cost = 0
    integer(c_int) :: sensors = 0, modes = 0, threads = 0
    integer(c_long) :: seed = 0
    integer(c_int) :: speed = 0, speed_backward = 0
  end type rotid_suggest_options

  type, bind(C) :: rotid_speeds_options
    integer(c_size_t) :: size = 56
    real(c_double) :: from_rpm = 0, to_rpm = 0, harmonic = 0
    integer(c_int) :: count = 0, draws = 0, threads = 0, no_fit = 0
    integer(c_long) :: seed = 0
  end type rotid_speeds_options

  ! ------------------------------------------------------------------------------------------------ types: your own model

  type, bind(C) :: rotid_matrix
    integer(c_int) :: n = 0, kd = 0, nfar = 0
    type(c_ptr) :: far = c_null_ptr   ! integer [nfar], from 0
    type(c_ptr) :: band = c_null_ptr  ! real [kd + 1, n], see rotid_band
    type(c_ptr) :: block = c_null_ptr ! real [nfar, nfar], see rotid_block
  end type rotid_matrix

  type, bind(C) :: rotid_model
    integer(c_size_t) :: size = 112
    integer(c_int) :: n = 0, kd = 0, nfar = 0
    type(c_ptr) :: far = c_null_ptr    ! integer [nfar], from 0; rotid_fit_model takes it as an array
    integer(c_int) :: nparam = 0
    integer(c_int) :: nrigid = 0
    integer(c_int) :: nmaster = 0
    type(c_ptr) :: master = c_null_ptr ! integer [nmaster], from 0; rotid_fit_model takes it as an array
    type(c_funptr) :: matrices = c_null_funptr    ! rotid_model_matrices
    type(c_funptr) :: derivatives = c_null_funptr ! rotid_model_derivatives
    type(c_ptr) :: user = c_null_ptr
    integer(c_int) :: nmodes = 0
    type(c_ptr) :: modes = c_null_ptr  ! real [n, nmodes]: vectors near the lowest modes, to begin with
    type(c_funptr) :: derivative_products = c_null_funptr ! rotid_model_derivative_products
    type(c_ptr) :: sensor = c_null_ptr ! real [n, nmaster]: the motion at a sensor is column times u; null: masters
  end type rotid_model

  type, bind(C) :: rotid_measured
    integer(c_size_t) :: size = 104
    integer(c_int) :: nmode = 0
    type(c_ptr) :: number = c_null_ptr        ! integer [nmode]
    type(c_ptr) :: frequency_hz = c_null_ptr  ! real [nmode]
    type(c_ptr) :: frequency_std = c_null_ptr ! real [nmode]
    type(c_ptr) :: shape = c_null_ptr         ! real [nmaster, nmode]
    type(c_ptr) :: shape_std = c_null_ptr     ! real [nmaster, nmode]
    type(c_ptr) :: holdout = c_null_ptr       ! integer [nmode]
    type(c_ptr) :: whole = c_null_ptr         ! real [n, 2]
    real(c_double) :: mass = 0
    real(c_double) :: mass_std = 0
    real(c_double) :: centre = 0
    real(c_double) :: centre_std = 0
  end type rotid_measured

  type, bind(C) :: rotid_state
    integer(c_size_t) :: size = 32
    type(c_ptr) :: model = c_null_ptr     ! rotid_model
    type(c_ptr) :: measured = c_null_ptr  ! rotid_measured
    type(c_ptr) :: parameter = c_null_ptr ! integer [nparam of the model], from 0
  end type rotid_state

  type, bind(C) :: rotid_host_cause
    integer(c_size_t) :: size = 72
    type(c_ptr) :: name = c_null_ptr, target = c_null_ptr ! texts that end with c_null_char
    integer(c_int) :: nparameter = 0
    type(c_ptr) :: parameter = c_null_ptr ! rotid_parameter [nparameter]
    type(c_ptr) :: neutral = c_null_ptr   ! real [nparameter]
    type(c_ptr) :: deviation = c_null_ptr ! real [nparameter]
    type(c_funptr) :: add = c_null_funptr ! rotid_host_cause_add
    type(c_ptr) :: user = c_null_ptr
  end type rotid_host_cause

  type, bind(C) :: rotid_host_options
    integer(c_size_t) :: size = 32
    type(c_ptr) :: position = c_null_ptr  ! real [nmaster]
    real(c_double) :: length = 0
    integer(c_int) :: changed = 0, reserved = 0
  end type rotid_host_options

  type, bind(C) :: rotid_host_explanation
    integer(c_int) :: ncause = 0, cause(3) = 0 ! indices, from 0
    integer(c_int) :: something_else = 0
    real(c_double) :: probability = 0
    real(c_double) :: chi2 = 0
    real(c_double) :: value(12) = 0, std(12) = 0
  end type rotid_host_explanation

  type, bind(C) :: rotid_host_diagnosis
    integer(c_int) :: verdict = 0
    real(c_double) :: nothing = 0, something_else = 0
    integer(c_int) :: nexplanation = 0
    type(c_ptr) :: explanation = c_null_ptr ! rotid_host_explanation [nexplanation]
    integer(c_int) :: ncause = 0
    type(c_ptr) :: probability = c_null_ptr ! real [ncause]
    integer(c_int) :: nparameter = 0
    type(c_ptr) :: mean = c_null_ptr, std = c_null_ptr, ci_lower = c_null_ptr, ci_upper = c_null_ptr ! real [nparameter]
    integer(c_int) :: dof = 0
    real(c_double) :: chi2 = 0
    type(c_ptr) :: memory = c_null_ptr
  end type rotid_host_diagnosis

  type, bind(C) :: rotid_fit_options
    integer(c_size_t) :: size = 80
    integer(c_int) :: functional = 0, reduction = 0, derivative = 0
    integer(c_int) :: baseline = 0
    integer(c_int) :: max_iterations = 0
    real(c_double) :: gradient_tolerance = 0
    real(c_double) :: step_tolerance = 0
    real(c_double) :: bijection_chi = 0
    real(c_double) :: decrease_tolerance = 0
    real(c_double) :: objective_tolerance = 0
    real(c_double) :: decrease_least = 0
  end type rotid_fit_options

  type, bind(C) :: rotid_fit_iteration
    integer(c_int) :: iteration = 0
    real(c_double) :: objective = 0
    real(c_double) :: gradient = 0
    real(c_double) :: mu = 0
    real(c_double) :: gain_ratio = 0
    real(c_double) :: step = 0
    real(c_double) :: seconds = 0
  end type rotid_fit_iteration

  type, bind(C) :: rotid_baseline
    type(c_ptr) :: algorithm = c_null_ptr, result = c_null_ptr
    integer(c_int) :: code = 0
    integer(c_int) :: usable = 0
    real(c_double) :: objective = 0, seconds = 0, gradient = 0
    integer(c_int) :: evaluations = 0
    type(c_ptr) :: x = c_null_ptr ! real [nparam]
  end type rotid_baseline

  type, bind(C) :: rotid_fit_result
    integer(c_int) :: status = 0
    integer(c_int) :: converged = 0
    integer(c_int) :: any_at_bound = 0, any_undetermined = 0
    integer(c_int) :: n = 0, m = 0, nresidual = 0, dof = 0
    real(c_double) :: objective = 0, gradient = 0, chi2 = 0, chi2_per_dof = 0
    integer(c_int) :: iterations = 0, evaluations = 0, jacobians = 0
    real(c_double) :: seconds = 0
    type(c_ptr) :: x = c_null_ptr, std = c_null_ptr, ci_lower = c_null_ptr, ci_upper = c_null_ptr ! real [n]
    type(c_ptr) :: at_bound = c_null_ptr, identifiable = c_null_ptr                               ! integer [n]
    type(c_ptr) :: covariance = c_null_ptr, correlation = c_null_ptr                              ! real [n, n]
    real(c_double) :: condition_number = 0
    type(c_ptr) :: singular_value = c_null_ptr                                                    ! real [n]
    type(c_ptr) :: direction = c_null_ptr                                                         ! real [n, n]
    type(c_ptr) :: direction_undetermined = c_null_ptr                                            ! integer [n]
    real(c_double) :: widened_by = 0
    integer(c_int) :: variance_from_residuals = 0
    type(c_ptr) :: predicted_hz = c_null_ptr, mac = c_null_ptr, residual = c_null_ptr             ! real [m]
    type(c_ptr) :: r = c_null_ptr                                                                 ! real [nresidual]
    type(c_ptr) :: jacobian = c_null_ptr                                                          ! real [nresidual, n]
    integer(c_int) :: nhistory = 0
    type(c_ptr) :: history = c_null_ptr                                                           ! rotid_fit_iteration [nhistory]
    type(c_ptr) :: history_x = c_null_ptr                                                         ! real [n, nhistory]
    integer(c_int) :: nbaseline = 0
    type(c_ptr) :: baseline = c_null_ptr                                                          ! rotid_baseline [nbaseline]
    type(c_ptr) :: memory = c_null_ptr
    integer(c_int) :: nstate = 0
    type(c_ptr) :: state_m = c_null_ptr, state_nresidual = c_null_ptr                             ! integer [nstate]
  end type rotid_fit_result

  ! ------------------------------------------------------------------------------------------------ types: least squares

  type, bind(C) :: rotid_lm_iteration
    integer(c_int) :: iteration = 0
    real(c_double) :: objective = 0, mu = 0, gain_ratio = 0
    real(c_double) :: cosine = 0
    type(c_ptr) :: x = c_null_ptr, gradient = c_null_ptr ! real [n]
  end type rotid_lm_iteration

  type, bind(C) :: rotid_lm_options
    integer(c_size_t) :: size = 80
    integer(c_int) :: max_iterations = 0
    real(c_double) :: gradient_tolerance = 0
    real(c_double) :: step_tolerance = 0
    real(c_double) :: objective_tolerance = 0
    real(c_double) :: initial_damping = 0
    type(c_funptr) :: trace = c_null_funptr ! rotid_lm_options_trace
    type(c_ptr) :: trace_user = c_null_ptr
    real(c_double) :: decrease_tolerance = 0
    real(c_double) :: decrease_least = 0
  end type rotid_lm_options

  type, bind(C) :: rotid_lm_result
    integer(c_int) :: status = 0, iterations = 0, evaluations = 0, jacobians = 0
    real(c_double) :: objective = 0, cosine = 0, mu = 0
  end type rotid_lm_result

  ! ------------------------------------------------------------------------------------------------ what a host supplies

  abstract interface

    function rotid_host_cause_add(user, x, value, stiffness, mass) result(status) bind(C)
      import :: c_ptr, c_int, c_double, rotid_matrix
      type(c_ptr), value :: user
      real(c_double), intent(in) :: x(*), value(*)
      type(rotid_matrix), intent(inout), target :: stiffness, mass
      integer(c_int) :: status
    end function rotid_host_cause_add

    function rotid_allocator_allocate(context, bytes) result(block) bind(C)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: context
      integer(c_size_t), value :: bytes
      type(c_ptr) :: block
    end function rotid_allocator_allocate

    subroutine rotid_allocator_release(context, block) bind(C)
      import :: c_ptr
      type(c_ptr), value :: context, block
    end subroutine rotid_allocator_release

    function rotid_environment_cancelled(context) result(stop) bind(C)
      import :: c_ptr, c_int
      type(c_ptr), value :: context
      integer(c_int) :: stop
    end function rotid_environment_cancelled

    subroutine rotid_environment_progress(context, stage, step) bind(C)
      import :: c_ptr, c_int
      type(c_ptr), value :: context, stage
      integer(c_int), value :: step
    end subroutine rotid_environment_progress

    ! x [nparam]; stiffness and mass come with the structure of the model and set to zero
    function rotid_model_matrices(user, x, stiffness, mass) result(failure) bind(C)
      import :: c_ptr, c_int, c_double, rotid_matrix
      type(c_ptr), value :: user
      real(c_double), intent(in) :: x(*)
      type(rotid_matrix), intent(inout), target :: stiffness, mass
      integer(c_int) :: failure
    end function rotid_model_matrices

    ! p counts from 0: it is x(p + 1) by which the matrices are differentiated
    function rotid_model_derivatives(user, x, p, stiffness, mass) result(failure) bind(C)
      import :: c_ptr, c_int, c_double, rotid_matrix
      type(c_ptr), value :: user
      real(c_double), intent(in) :: x(*)
      integer(c_int), value :: p
      type(rotid_matrix), intent(inout), target :: stiffness, mass
      integer(c_int) :: failure
    end function rotid_model_derivatives

    function rotid_model_derivative_products(user, x, p, count, u, dk_u, dm_u) result(refused) bind(C)
      import :: c_ptr, c_int, c_double
      type(c_ptr), value :: user
      real(c_double), intent(in) :: x(*)
      integer(c_int), value :: p, count
      real(c_double), intent(in) :: u(*)
      real(c_double), intent(inout) :: dk_u(*), dm_u(*)
      integer(c_int) :: refused
    end function rotid_model_derivative_products

    ! r [m], jacobian [m, n]: one of the two is null
    function rotid_residual(user, m, n, x, r, jacobian) result(failure) bind(C)
      import :: c_ptr, c_int, c_double
      type(c_ptr), value :: user
      integer(c_int), value :: m, n
      real(c_double), intent(in) :: x(*)
      type(c_ptr), value :: r, jacobian
      integer(c_int) :: failure
    end function rotid_residual

    function rotid_lm_options_trace(user, iteration) result(cancel) bind(C)
      import :: c_ptr, c_int, rotid_lm_iteration
      type(c_ptr), value :: user
      type(rotid_lm_iteration), intent(in) :: iteration
      integer(c_int) :: cancel
    end function rotid_lm_options_trace

  end interface

  ! ------------------------------------------------------------------------------------------------ routines of rotid.h

  interface

    function rotid_version() result(text) bind(C, name="rotid_version")
      import :: c_ptr
      type(c_ptr) :: text
    end function rotid_version

    function rotid_status_text(status) result(text) bind(C, name="rotid_status_text")
      import :: c_ptr, c_int
      integer(c_int), value :: status
      type(c_ptr) :: text
    end function rotid_status_text

    function rotid_status_name(status) result(text) bind(C, name="rotid_status_name")
      import :: c_ptr, c_int
      integer(c_int), value :: status
      type(c_ptr) :: text
    end function rotid_status_name

    function rotid_status_converged(status) result(converged) bind(C, name="rotid_status_converged")
      import :: c_int
      integer(c_int), value :: status
      integer(c_int) :: converged
    end function rotid_status_converged

    ! ---- run a deck; with strings and optional arguments: rotid_read_deck, rotid_read_deck_text, rotid_check_deck,
    ! rotid_compute_spectrum, rotid_identify_deck, rotid_diagnose_deck, rotid_suggest_deck, rotid_speeds_deck, rotid_free

    function rotid_deck_read(path, noverride, override, environment, failure, deck) result(status) bind(C, name="rotid_deck_read")
      import :: c_char, c_ptr, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: noverride
      type(c_ptr), value :: override    ! type(c_ptr) [noverride]
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: deck
      integer(c_int) :: status
    end function rotid_deck_read

    function rotid_deck_read_text(length, text, name, directory, noverride, override, environment, failure, deck) result(status) &
      bind(C, name="rotid_deck_read_text")
      import :: c_char, c_ptr, c_int, c_size_t
      integer(c_size_t), value :: length
      character(kind=c_char), intent(in) :: text(*)
      type(c_ptr), value :: name, directory ! texts
      integer(c_int), value :: noverride
      type(c_ptr), value :: override        ! type(c_ptr) [noverride]
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: deck
      integer(c_int) :: status
    end function rotid_deck_read_text

    subroutine rotid_deck_free(deck) bind(C, name="rotid_deck_free")
      import :: c_ptr
      type(c_ptr), value :: deck
    end subroutine rotid_deck_free

    function rotid_deck_check(deck, environment, failure, check) result(status) bind(C, name="rotid_deck_check")
      import :: c_ptr, c_int
      type(c_ptr), value :: deck
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: check
      integer(c_int) :: status
    end function rotid_deck_check

    subroutine rotid_check_free(check) bind(C, name="rotid_check_free")
      import :: c_ptr
      type(c_ptr), value :: check
    end subroutine rotid_check_free

    function rotid_spectrum_compute(deck, x, nmode, environment, failure, spectrum) result(status) &
      bind(C, name="rotid_spectrum_compute")
      import :: c_ptr, c_int
      type(c_ptr), value :: deck
      type(c_ptr), value :: x           ! real [nparameter]
      integer(c_int), value :: nmode
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: spectrum
      integer(c_int) :: status
    end function rotid_spectrum_compute

    function rotid_spectrum_beside(deck, x, nmode, environment, failure, spectrum) result(status) &
      bind(C, name="rotid_spectrum_beside")
      import :: c_ptr, c_int
      type(c_ptr), value :: deck
      type(c_ptr), value :: x           ! real [nparameter]
      integer(c_int), value :: nmode
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: spectrum
      integer(c_int) :: status
    end function rotid_spectrum_beside

    function rotid_spectrum_of_type(deck, type, x, nmode, environment, failure, spectrum) result(status) &
      bind(C, name="rotid_spectrum_of_type")
      import :: c_ptr, c_int
      type(c_ptr), value :: deck
      integer(c_int), value :: type
      type(c_ptr), value :: x           ! real [nparameter]
      integer(c_int), value :: nmode
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: spectrum
      integer(c_int) :: status
    end function rotid_spectrum_of_type

    subroutine rotid_spectrum_free(spectrum) bind(C, name="rotid_spectrum_free")
      import :: c_ptr
      type(c_ptr), value :: spectrum
    end subroutine rotid_spectrum_free

    function rotid_identify(deck, baseline, environment, failure, result) result(status) bind(C, name="rotid_identify")
      import :: c_ptr, c_int
      type(c_ptr), value :: deck
      integer(c_int), value :: baseline
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: result
      integer(c_int) :: status
    end function rotid_identify

    subroutine rotid_identification_free(result) bind(C, name="rotid_identification_free")
      import :: c_ptr
      type(c_ptr), value :: result
    end subroutine rotid_identification_free

    function rotid_diagnose(deck, options, environment, failure, result) result(status) bind(C, name="rotid_diagnose")
      import :: c_ptr, c_int
      type(c_ptr), value :: deck
      type(c_ptr), value :: options, environment, failure
      type(c_ptr), intent(out) :: result
      integer(c_int) :: status
    end function rotid_diagnose

    subroutine rotid_diagnosis_free(result) bind(C, name="rotid_diagnosis_free")
      import :: c_ptr
      type(c_ptr), value :: result
    end subroutine rotid_diagnosis_free

    function rotid_suggest(deck, options, environment, failure, result) result(status) bind(C, name="rotid_suggest")
      import :: c_ptr, c_int
      type(c_ptr), value :: deck
      type(c_ptr), value :: options, environment, failure
      type(c_ptr), intent(out) :: result
      integer(c_int) :: status
    end function rotid_suggest

    subroutine rotid_suggestion_free(result) bind(C, name="rotid_suggestion_free")
      import :: c_ptr
      type(c_ptr), value :: result
    end subroutine rotid_suggestion_free

    function rotid_speeds_compute(deck, options, environment, failure, result) result(status) &
        bind(C, name="rotid_speeds_compute")
      import :: c_ptr, c_int
      type(c_ptr), value :: deck
      type(c_ptr), value :: options, environment, failure
      type(c_ptr), intent(out) :: result
      integer(c_int) :: status
    end function rotid_speeds_compute

    subroutine rotid_speeds_free(result) bind(C, name="rotid_speeds_free")
      import :: c_ptr
      type(c_ptr), value :: result
    end subroutine rotid_speeds_free

    function rotid_verdict_name(kind) result(text) bind(C, name="rotid_verdict_name")
      import :: c_ptr, c_int
      integer(c_int), value :: kind
      type(c_ptr) :: text
    end function rotid_verdict_name

    ! ---- your own model; with arrays and optional arguments: rotid_fit_model, rotid_free

    subroutine rotid_fit_defaults(size, options) bind(C, name="rotid_fit_defaults")
      import :: c_size_t, rotid_fit_options
      integer(c_size_t), value :: size ! c_sizeof(options)
      type(rotid_fit_options), intent(out) :: options
    end subroutine rotid_fit_defaults

    function rotid_fit(model, parameter, measured, options, environment, failure, result) result(status) bind(C, name="rotid_fit")
      import :: c_ptr, c_int, rotid_model, rotid_parameter, rotid_measured, rotid_fit_options
      type(rotid_model), intent(in), target :: model
      type(rotid_parameter), intent(in) :: parameter(*)
      type(rotid_measured), intent(in) :: measured
      type(rotid_fit_options), intent(in) :: options
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: result
      integer(c_int) :: status
    end function rotid_fit

    function rotid_fit_states(nstate, state, nparam, parameter, options, environment, failure, result) result(status) &
        bind(C, name="rotid_fit_states")
      import :: c_ptr, c_int, rotid_state, rotid_parameter, rotid_fit_options
      integer(c_int), value :: nstate
      type(rotid_state), intent(in) :: state(*)
      integer(c_int), value :: nparam
      type(rotid_parameter), intent(in) :: parameter(*)
      type(rotid_fit_options), intent(in) :: options
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: result
      integer(c_int) :: status
    end function rotid_fit_states

    subroutine rotid_fit_free(result) bind(C, name="rotid_fit_free")
      import :: c_ptr
      type(c_ptr), value :: result
    end subroutine rotid_fit_free

    function rotid_diagnose_model(model, parameter, measured, ncause, cause, options, environment, failure, diagnosis) &
        result(status) bind(C, name="rotid_diagnose_model")
      import :: c_ptr, c_int, rotid_model, rotid_parameter, rotid_measured, rotid_host_cause
      type(rotid_model), intent(in) :: model
      type(rotid_parameter), intent(in) :: parameter(*)
      type(rotid_measured), intent(in) :: measured
      integer(c_int), value :: ncause
      type(rotid_host_cause), intent(in) :: cause(*)
      type(c_ptr), value :: options             ! rotid_host_options
      type(c_ptr), value :: environment, failure
      type(c_ptr), intent(out) :: diagnosis
      integer(c_int) :: status
    end function rotid_diagnose_model

    subroutine rotid_host_diagnosis_free(diagnosis) bind(C, name="rotid_host_diagnosis_free")
      import :: c_ptr
      type(c_ptr), value :: diagnosis
    end subroutine rotid_host_diagnosis_free

    function rotid_check_model(model, parameter, x, environment, failure, error, doubt) result(status) &
        bind(C, name="rotid_check_model")
      import :: c_double, c_ptr, c_int, rotid_model, rotid_parameter
      type(rotid_model), intent(in), target :: model
      type(rotid_parameter), intent(in) :: parameter(*)
      type(c_ptr), value :: x                   ! real [nparam]
      type(c_ptr), value :: environment, failure
      real(c_double), intent(inout) :: error(*), doubt(*)
      integer(c_int) :: status
    end function rotid_check_model

    ! ---- building blocks: the beam

    function rotid_shear_coefficient_annulus(nu, a) result(coefficient) bind(C, name="rotid_shear_coefficient_annulus")
      import :: c_double
      real(c_double), value :: nu, a
      real(c_double) :: coefficient
    end function rotid_shear_coefficient_annulus

    function rotid_shear_coefficient_rectangle(nu) result(coefficient) bind(C, name="rotid_shear_coefficient_rectangle")
      import :: c_double
      real(c_double), value :: nu
      real(c_double) :: coefficient
    end function rotid_shear_coefficient_rectangle

    function rotid_equivalent_cylinder(area, inertia, failure, outer, inner) result(status) &
      bind(C, name="rotid_equivalent_cylinder")
      import :: c_double, c_int, c_ptr
      real(c_double), value :: area, inertia
      type(c_ptr), value :: failure
      real(c_double), intent(out) :: outer, inner
      integer(c_int) :: status
    end function rotid_equivalent_cylinder

    subroutine rotid_element_stiffness(ei, kgs, l, stiffness) bind(C, name="rotid_element_stiffness")
      import :: c_double
      real(c_double), value :: ei, kgs, l
      real(c_double), intent(out) :: stiffness(4, 4)
    end subroutine rotid_element_stiffness

    subroutine rotid_element_geometric(force, phi, l, stiffness) bind(C, name="rotid_element_geometric")
      import :: c_double
      real(c_double), value :: force, phi, l
      real(c_double), intent(out) :: stiffness(4, 4)
    end subroutine rotid_element_geometric

    subroutine rotid_element_mass(rhos, rhoi, phi, l, mass) bind(C, name="rotid_element_mass")
      import :: c_double
      real(c_double), value :: rhos, rhoi, phi, l
      real(c_double), intent(out) :: mass(4, 4)
    end subroutine rotid_element_mass

    ! ---- building blocks: matrices; with indices from 1: rotid_add, rotid_add_element, rotid_set_full

    function rotid_matrix_add(a, i, j, value, failure) result(status) bind(C, name="rotid_matrix_add")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(inout) :: a
      integer(c_int), value :: i, j
      real(c_double), value :: value
      type(c_ptr), value :: failure
      integer(c_int) :: status
    end function rotid_matrix_add

    function rotid_matrix_add_element(a, nd, dof, e, failure) result(status) bind(C, name="rotid_matrix_add_element")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(inout) :: a
      integer(c_int), value :: nd
      integer(c_int), intent(in) :: dof(*)
      real(c_double), intent(in) :: e(nd, *)
      type(c_ptr), value :: failure
      integer(c_int) :: status
    end function rotid_matrix_add_element

    function rotid_matrix_set_dense(a, full, ld, failure) result(status) bind(C, name="rotid_matrix_set_dense")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(inout) :: a
      integer(c_int), value :: ld
      real(c_double), intent(in) :: full(ld, *)
      type(c_ptr), value :: failure
      integer(c_int) :: status
    end function rotid_matrix_set_dense

    function rotid_matrix_get_dense(a, full, ld, failure) result(status) bind(C, name="rotid_matrix_get_dense")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(in) :: a
      integer(c_int), value :: ld
      real(c_double), intent(inout) :: full(ld, *)
      type(c_ptr), value :: failure
      integer(c_int) :: status
    end function rotid_matrix_get_dense

    function rotid_matrix_multiply(a, columns, x, y, failure) result(status) bind(C, name="rotid_matrix_multiply")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(in) :: a
      integer(c_int), value :: columns
      real(c_double), intent(in) :: x(a%n, *)
      real(c_double), intent(inout) :: y(a%n, *)
      type(c_ptr), value :: failure
      integer(c_int) :: status
    end function rotid_matrix_multiply

    function rotid_condense(k, m, nmaster, master, kind, environment, failure, kc, mc, t) result(status) &
      bind(C, name="rotid_condense")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(in) :: k, m
      integer(c_int), value :: nmaster
      integer(c_int), intent(in) :: master(*)   ! from 0
      integer(c_int), value :: kind
      type(c_ptr), value :: environment, failure
      real(c_double), intent(inout) :: kc(nmaster, *), mc(nmaster, *)
      type(c_ptr), value :: t                   ! real [n, nmaster]
      integer(c_int) :: status
    end function rotid_condense

    function rotid_condense_derivative(k, m, dk, dm, nmaster, master, kind, environment, failure, dkc, dmc) result(status) &
      bind(C, name="rotid_condense_derivative")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(in) :: k, m, dk, dm
      integer(c_int), value :: nmaster
      integer(c_int), intent(in) :: master(*)   ! from 0
      integer(c_int), value :: kind
      type(c_ptr), value :: environment, failure
      real(c_double), intent(inout) :: dkc(nmaster, *), dmc(nmaster, *)
      integer(c_int) :: status
    end function rotid_condense_derivative

    function rotid_eigenpairs(k, m, count, environment, failure, lambda, phi) result(status) bind(C, name="rotid_eigenpairs")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(in) :: k, m
      integer(c_int), value :: count
      type(c_ptr), value :: environment, failure
      real(c_double), intent(inout) :: lambda(*), phi(k%n, *)
      integer(c_int) :: status
    end function rotid_eigenpairs

    function rotid_eigenpair_derivative(k, m, dk, dm, count, lambda, phi, j, environment, failure, dlambda, dphi) result(status) &
      bind(C, name="rotid_eigenpair_derivative")
      import :: c_double, c_int, c_ptr, rotid_matrix
      type(rotid_matrix), intent(in) :: k, m, dk, dm
      integer(c_int), value :: count
      real(c_double), intent(in) :: lambda(*), phi(k%n, *)
      integer(c_int), value :: j                ! from 0
      type(c_ptr), value :: environment, failure
      real(c_double), intent(out) :: dlambda
      type(c_ptr), value :: dphi                ! real [n]
      integer(c_int) :: status
    end function rotid_eigenpair_derivative

    ! ---- building blocks: least squares

    function rotid_lm_workspace(m, n) result(length) bind(C, name="rotid_lm_workspace")
      import :: c_int, c_size_t
      integer(c_int), value :: m, n
      integer(c_size_t) :: length
    end function rotid_lm_workspace

    function rotid_lm(m, n, residual, user, options, failure, x, r, jacobian, work, result) result(status) &
      bind(C, name="rotid_lm")
      import :: c_double, c_int, c_ptr, c_funptr, rotid_lm_result
      integer(c_int), value :: m, n
      type(c_funptr), value :: residual         ! rotid_residual
      type(c_ptr), value :: user
      type(c_ptr), value :: options             ! a rotid_lm_options
      type(c_ptr), value :: failure
      real(c_double), intent(inout) :: x(*), r(*), jacobian(m, *), work(*)
      type(rotid_lm_result), intent(inout) :: result
      integer(c_int) :: status
    end function rotid_lm

    function rotid_check_jacobian_workspace(m, n) result(length) bind(C, name="rotid_check_jacobian_workspace")
      import :: c_int, c_size_t
      integer(c_int), value :: m, n
      integer(c_size_t) :: length
    end function rotid_check_jacobian_workspace

    function rotid_check_jacobian(m, n, residual, user, x, scale, failure, error, doubt, work) result(status) &
      bind(C, name="rotid_check_jacobian")
      import :: c_double, c_int, c_ptr, c_funptr
      integer(c_int), value :: m, n
      type(c_funptr), value :: residual         ! rotid_residual
      type(c_ptr), value :: user
      real(c_double), intent(in) :: x(*)
      type(c_ptr), value :: scale               ! real [n]
      type(c_ptr), value :: failure
      real(c_double), intent(inout) :: error(*), doubt(*), work(*)
      integer(c_int) :: status
    end function rotid_check_jacobian

    ! ---- building blocks: modes

    function rotid_mac(n, a, b) result(mac) bind(C, name="rotid_mac")
      import :: c_double, c_int
      integer(c_int), value :: n
      real(c_double), intent(in) :: a(*), b(*)
      real(c_double) :: mac
    end function rotid_mac

    function rotid_nco(n, mass, a, b, work) result(nco) bind(C, name="rotid_nco")
      import :: c_double, c_int
      integer(c_int), value :: n
      real(c_double), intent(in) :: mass(n, *), a(*), b(*)
      real(c_double), intent(inout) :: work(*)
      real(c_double) :: nco
    end function rotid_nco

  end interface

  ! ------------------------------------------------------------------------------------------------ for Fortran

  ! Frees a deck or a result and nullifies its pointer; a null pointer is allowed.
  interface rotid_free
    module procedure free_deck, free_check, free_spectrum, free_identification, free_diagnosis, free_suggestion, free_speeds, &
      free_fit
  end interface rotid_free

  ! rotid_reals(member, n), rotid_reals(member, m, n): the array behind a member; null where the member is.
  interface rotid_reals
    module procedure real_vector, real_matrix
  end interface rotid_reals

  interface
    pure function c_length(text) result(length) bind(C, name="strlen")
      import :: c_ptr, c_size_t
      type(c_ptr), value :: text
      integer(c_size_t) :: length
    end function c_length
  end interface

  private :: free_deck, free_check, free_spectrum, free_identification, free_diagnosis, free_suggestion, free_speeds, &
    free_fit, &
             real_vector, real_matrix, &
             c_length, &
             c_string, c_strings, ones_to_zeros

contains

  ! ---- texts

  ! A text of the library; empty where `text` is null.
  function rotid_string(text) result(string)
    type(c_ptr), intent(in) :: text
    character(len=:), allocatable :: string
    character(kind=c_char), pointer :: c(:)
    integer :: i
    if (.not. c_associated(text)) then
      string = ""
      return
    end if
    call c_f_pointer(text, c, [c_length(text)])
    allocate (character(len=size(c)) :: string)
    do i = 1, size(c)
      string(i:i) = c(i)
    end do
  end function rotid_string

  ! "out of memory" for ROTID_ERROR_MEMORY.
  function rotid_status_message(status) result(string)
    integer(c_int), intent(in) :: status
    character(len=:), allocatable :: string
    string = rotid_string(rotid_status_text(status))
  end function rotid_status_message

  ! "rotor.inp:12:3: error: what is wrong, what was expected"
  function rotid_message_text(message) result(string)
    type(rotid_message), intent(in) :: message
    character(len=:), allocatable :: string
    character(len=7), parameter :: severity(0:2) = [character(len=7) :: "note", "warning", "error"]
    character(len=40) :: place
    string = ""
    if (c_associated(message%file)) string = rotid_string(message%file) // ":"
    if (message%line > 0) then
      write (place, "(i0,':')") message%line
      if (message%column > 0) write (place, "(i0,':',i0,':')") message%line, message%column
      string = string // trim(place)
    end if
    if (len(string) > 0) string = string // " "
    if (message%severity >= 0 .and. message%severity <= 2) string = string // trim(severity(message%severity)) // ": "
    string = string // rotid_string(message%text)
  end function rotid_message_text

  ! ---- arrays behind members

  function real_vector(member, n) result(array)
    type(c_ptr), intent(in) :: member
    integer(c_int), intent(in) :: n
    real(c_double), pointer, contiguous :: array(:)
    nullify (array)
    if (c_associated(member)) call c_f_pointer(member, array, [n])
  end function real_vector

  function real_matrix(member, m, n) result(array)
    type(c_ptr), intent(in) :: member
    integer(c_int), intent(in) :: m, n
    real(c_double), pointer, contiguous :: array(:, :)
    nullify (array)
    if (c_associated(member)) call c_f_pointer(member, array, [m, n])
  end function real_matrix

  function rotid_integers(member, n) result(array)
    type(c_ptr), intent(in) :: member
    integer(c_int), intent(in) :: n
    integer(c_int), pointer, contiguous :: array(:)
    nullify (array)
    if (c_associated(member)) call c_f_pointer(member, array, [n])
  end function rotid_integers

  ! The messages of a deck or a result: rotid_messages(deck%message, deck%nmessage).
  function rotid_messages(member, n) result(array)
    type(c_ptr), intent(in) :: member
    integer(c_int), intent(in) :: n
    type(rotid_message), pointer, contiguous :: array(:)
    nullify (array)
    if (c_associated(member)) call c_f_pointer(member, array, [n])
  end function rotid_messages

  ! ---- matrices, indices from 1

  ! Packed band [kd + 1, n] of the lower triangle as in LAPACK's 'L' storage: A(i, j) = band(1 + i - j, j), j <= i <= j + kd.
  function rotid_band(matrix) result(band)
    type(rotid_matrix), intent(in), target :: matrix
    real(c_double), pointer, contiguous :: band(:, :)
    band => real_matrix(matrix%band, matrix%kd + 1_c_int, matrix%n)
  end function rotid_band

  ! Dense block [nfar, nfar]; row i belongs to the i-th far degree of freedom.
  function rotid_block(matrix) result(block)
    type(rotid_matrix), intent(in), target :: matrix
    real(c_double), pointer, contiguous :: block(:, :)
    block => real_matrix(matrix%block, matrix%nfar, matrix%nfar)
  end function rotid_block

  ! A(i, j) += value and A(j, i) with it. Statuses as rotid_matrix_add.
  function rotid_add(matrix, i, j, value, failure) result(status)
    type(rotid_matrix), intent(inout) :: matrix
    integer, intent(in) :: i, j
    real(c_double), intent(in) :: value
    character(len=:), allocatable, intent(out), optional :: failure
    integer(c_int) :: status
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    status = rotid_matrix_add(matrix, int(max(i, 0) - 1, c_int), int(max(j, 0) - 1, c_int), value, c_loc(why))
    if (present(failure)) failure = rotid_string(c_loc(why))
  end function rotid_add

  ! Adds the symmetric element matrix e(nd, nd) on the degrees of freedom dof(nd), from 1; one that is 0 or negative is left out
  ! (held). Statuses as rotid_matrix_add_element; ROTID_ERROR_ARGUMENT also where the sizes of dof and e do not agree.
  function rotid_add_element(matrix, dof, e, failure) result(status)
    type(rotid_matrix), intent(inout) :: matrix
    integer, intent(in) :: dof(:)
    real(c_double), intent(in) :: e(:, :)
    character(len=:), allocatable, intent(out), optional :: failure
    integer(c_int) :: status
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    status = ROTID_ERROR_ARGUMENT
    if (present(failure)) failure = 'e has another shape than size(dof) x size(dof)'
    if (size(e, 1) /= size(dof) .or. size(e, 2) /= size(dof)) return
    status = rotid_matrix_add_element(matrix, size(dof, kind=c_int), int(max(dof, 0) - 1, c_int), e, c_loc(why))
    if (present(failure)) failure = rotid_string(c_loc(why))
  end function rotid_add_element

  ! A := full(n, n), of which the lower triangle is read. Statuses as rotid_matrix_set_dense; ROTID_ERROR_ARGUMENT also where the
  ! sizes do not agree.
  function rotid_set_full(matrix, full, failure) result(status)
    type(rotid_matrix), intent(inout) :: matrix
    real(c_double), intent(in) :: full(:, :)
    character(len=:), allocatable, intent(out), optional :: failure
    integer(c_int) :: status
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    status = ROTID_ERROR_ARGUMENT
    if (present(failure)) failure = 'full has another shape than matrix%n x matrix%n'
    if (size(full, 1) /= matrix%n .or. size(full, 2) /= matrix%n) return
    status = rotid_matrix_set_dense(matrix, full, matrix%n, c_loc(why))
    if (present(failure)) failure = rotid_string(c_loc(why))
  end function rotid_set_full

  ! ---- run a deck

  ! rotid_deck_read with a path and overrides "CARD.OPTION=VALUE" of any length; blanks at their ends do not count.
  function rotid_read_deck(path, deck, override, environment, failure) result(status)
    character(len=*), intent(in) :: path
    type(rotid_deck), pointer, intent(out) :: deck
    character(len=*), intent(in), optional :: override(:)
    type(rotid_environment), intent(in), optional, target :: environment
    character(len=:), allocatable, intent(out), optional :: failure
    type(rotid_environment), target :: given
    integer(c_int) :: status
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    character(kind=c_char), allocatable, target :: text(:, :)
    type(c_ptr), allocatable, target :: pointers(:)
    type(c_ptr) :: c_deck
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (deck)
    call c_strings(override, text, pointers)
    status = rotid_deck_read(c_string(path), size(pointers, kind=c_int) - 1_c_int, c_loc(pointers), c_loc(given), c_loc(why), &
                             c_deck)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_deck)) call c_f_pointer(c_deck, deck)
  end function rotid_read_deck

  ! rotid_deck_read_text of a deck whose lines end with new_line('a'); `name` is "deck" and there are no files without them.
  function rotid_read_deck_text(text, deck, name, directory, override, environment, failure) result(status)
    character(len=*), intent(in) :: text
    type(rotid_deck), pointer, intent(out) :: deck
    character(len=*), intent(in), optional :: name, directory, override(:)
    type(rotid_environment), intent(in), optional, target :: environment
    character(len=:), allocatable, intent(out), optional :: failure
    type(rotid_environment), target :: given
    integer(c_int) :: status
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    character(kind=c_char), allocatable, target :: c_override(:, :), c_name(:), c_directory(:)
    type(c_ptr), allocatable, target :: pointers(:)
    type(c_ptr) :: c_deck, at_name, at_directory
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (deck)
    at_name = c_null_ptr
    if (present(name)) then
      c_name = c_string(name)
      at_name = c_loc(c_name)
    end if
    at_directory = c_null_ptr
    if (present(directory)) then
      c_directory = c_string(directory)
      at_directory = c_loc(c_directory)
    end if
    call c_strings(override, c_override, pointers)
    status = rotid_deck_read_text(len(text, kind=c_size_t), text, at_name, at_directory, size(pointers, kind=c_int) - 1_c_int, &
                                  c_loc(pointers), c_loc(given), c_loc(why), c_deck)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_deck)) call c_f_pointer(c_deck, deck)
  end function rotid_read_deck_text

  ! rotid_deck_check.
  function rotid_check_deck(deck, check, environment, failure) result(status)
    type(rotid_deck), intent(in), target :: deck
    type(rotid_check), pointer, intent(out) :: check
    type(rotid_environment), intent(in), optional, target :: environment
    character(len=:), allocatable, intent(out), optional :: failure
    type(rotid_environment), target :: given
    integer(c_int) :: status
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    type(c_ptr) :: c_check
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (check)
    status = rotid_deck_check(c_loc(deck), c_loc(given), c_loc(why), c_check)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_check)) call c_f_pointer(c_check, check)
  end function rotid_check_deck

  ! rotid_spectrum_compute; without x at the starts of the parameters.
  function rotid_compute_spectrum(deck, nmode, spectrum, x, environment, failure) result(status)
    type(rotid_deck), intent(in), target :: deck
    integer, intent(in) :: nmode
    type(rotid_spectrum), pointer, intent(out) :: spectrum
    real(c_double), intent(in), optional :: x(:)
    type(rotid_environment), intent(in), optional, target :: environment
    character(len=:), allocatable, intent(out), optional :: failure
    type(rotid_environment), target :: given
    integer(c_int) :: status
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    real(c_double), allocatable, target :: values(:)
    type(c_ptr) :: c_spectrum, c_x
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (spectrum)
    c_x = c_null_ptr
    if (present(x)) then
      status = ROTID_ERROR_ARGUMENT
      if (present(failure)) failure = 'x has another size than deck%nparameter'
      if (size(x) /= deck%nparameter) return
      allocate (values(max(1, size(x))))
      values(1:size(x)) = x
      c_x = c_loc(values)
    end if
    status = rotid_spectrum_compute(c_loc(deck), c_x, int(nmode, c_int), c_loc(given), c_loc(why), c_spectrum)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_spectrum)) call c_f_pointer(c_spectrum, spectrum)
  end function rotid_compute_spectrum

  ! rotid_identify. An allocator in `environment` needs the attribute target and has to exist until the result is freed.
  function rotid_identify_deck(deck, found, baseline, environment, failure) result(status)
    type(rotid_deck), intent(in), target :: deck
    type(rotid_identification), pointer, intent(out) :: found
    logical, intent(in), optional :: baseline
    type(rotid_environment), intent(in), optional, target :: environment
    type(rotid_environment), target :: given
    character(len=:), allocatable, intent(out), optional :: failure
    integer(c_int) :: status, with_baseline
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    type(c_ptr) :: c_found
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (found)
    with_baseline = 0
    if (present(baseline)) with_baseline = merge(1_c_int, 0_c_int, baseline)
    status = rotid_identify(c_loc(deck), with_baseline, c_loc(given), c_loc(why), c_found)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_found)) call c_f_pointer(c_found, found)
  end function rotid_identify_deck

  ! rotid_diagnose; environment as above.
  function rotid_diagnose_deck(deck, found, options, environment, failure) result(status)
    type(rotid_deck), intent(in), target :: deck
    type(rotid_diagnosis), pointer, intent(out) :: found
    type(rotid_diagnose_options), intent(in), optional :: options
    type(rotid_environment), intent(in), optional, target :: environment
    type(rotid_environment), target :: given
    character(len=:), allocatable, intent(out), optional :: failure
    integer(c_int) :: status
    type(rotid_diagnose_options), target :: how
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    type(c_ptr) :: c_found
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (found)
    if (present(options)) how = options
    how%size = c_sizeof(how)
    status = rotid_diagnose(c_loc(deck), c_loc(how), c_loc(given), c_loc(why), c_found)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_found)) call c_f_pointer(c_found, found)
  end function rotid_diagnose_deck

  ! rotid_suggest; environment as above.
  function rotid_suggest_deck(deck, found, options, environment, failure) result(status)
    type(rotid_deck), intent(in), target :: deck
    type(rotid_suggestion), pointer, intent(out) :: found
    type(rotid_suggest_options), intent(in), optional :: options
    type(rotid_environment), intent(in), optional, target :: environment
    type(rotid_environment), target :: given
    character(len=:), allocatable, intent(out), optional :: failure
    integer(c_int) :: status
    type(rotid_suggest_options), target :: how
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    type(c_ptr) :: c_found
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (found)
    if (present(options)) how = options
    how%size = c_sizeof(how)
    status = rotid_suggest(c_loc(deck), c_loc(how), c_loc(given), c_loc(why), c_found)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_found)) call c_f_pointer(c_found, found)
  end function rotid_suggest_deck

  ! rotid_speeds_compute; environment as above.
  function rotid_speeds_deck(deck, found, options, environment, failure) result(status)
    type(rotid_deck), intent(in), target :: deck
    type(rotid_speeds), pointer, intent(out) :: found
    type(rotid_speeds_options), intent(in), optional :: options
    type(rotid_environment), intent(in), optional, target :: environment
    type(rotid_environment), target :: given
    character(len=:), allocatable, intent(out), optional :: failure
    integer(c_int) :: status
    type(rotid_speeds_options), target :: how
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    type(c_ptr) :: c_found
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (found)
    if (present(options)) how = options
    how%size = c_sizeof(how)
    status = rotid_speeds_compute(c_loc(deck), c_loc(how), c_loc(given), c_loc(why), c_found)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_found)) call c_f_pointer(c_found, found)
  end function rotid_speeds_deck

  ! ---- your own model

  ! rotid_fit with arrays. Of `model` n, kd, nrigid, matrices, derivatives and user are used; the number of parameters is the size
  ! of `parameter`, the masters are `master` and the far degrees of freedom `far`, increasing, from 1. Shapes are
  ! shape(size(master), size(number)). ROTID_ERROR_ARGUMENT also where sizes do not agree.
  function rotid_fit_model(model, parameter, number, frequency_hz, fit, frequency_std, shape, shape_std, holdout, master, far, &
                           options, environment, failure) result(status)
    type(rotid_model), intent(in), target :: model
    type(rotid_parameter), intent(in) :: parameter(:)
    integer, intent(in) :: number(:)
    real(c_double), intent(in) :: frequency_hz(:)
    type(rotid_fit_result), pointer, intent(out) :: fit
    real(c_double), intent(in), optional :: frequency_std(:), shape(:, :), shape_std(:, :)
    logical, intent(in), optional :: holdout(:)
    integer, intent(in), optional :: master(:), far(:)
    type(rotid_fit_options), intent(in), optional :: options
    type(rotid_environment), intent(in), optional, target :: environment
    character(len=:), allocatable, intent(out), optional :: failure
    type(rotid_environment), target :: given
    integer(c_int) :: status
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    type(rotid_model), target :: host
    type(rotid_measured), target :: measured
    type(rotid_fit_options), target :: how
    integer(c_int), allocatable, target :: c_master(:), c_far(:), c_number(:), c_holdout(:)
    real(c_double), allocatable, target :: c_hz(:), c_std(:), c_shape(:, :), c_shape_std(:, :)
    type(c_ptr) :: c_fit
    integer :: nmode, nmaster
    if (present(environment)) given = environment
    given%size = c_sizeof(given)
    nullify (fit)
    status = ROTID_ERROR_ARGUMENT
    nmode = size(number)
    nmaster = 0
    if (present(master)) nmaster = size(master)
    if (present(failure)) failure = 'number is empty, or frequency_hz has another size'
    if (nmode < 1 .or. size(frequency_hz) /= nmode) return

    host = model
    host%size = c_sizeof(host)
    host%nparam = size(parameter, kind=c_int)
    host%nmaster = int(nmaster, c_int)
    host%master = c_null_ptr
    if (nmaster > 0) then
      c_master = ones_to_zeros(master)
      host%master = c_loc(c_master)
    end if
    host%nfar = 0
    host%far = c_null_ptr
    if (present(far)) then
      if (size(far) > 0) then
        c_far = ones_to_zeros(far)
        host%nfar = size(far, kind=c_int)
        host%far = c_loc(c_far)
      end if
    end if

    measured%size = c_sizeof(measured)
    measured%nmode = int(nmode, c_int)
    c_number = int(number, c_int)
    measured%number = c_loc(c_number)
    c_hz = frequency_hz
    measured%frequency_hz = c_loc(c_hz)
    if (present(frequency_std)) then
      if (present(failure)) failure = 'frequency_std has another size than number'
      if (size(frequency_std) /= nmode) return
      c_std = frequency_std
      measured%frequency_std = c_loc(c_std)
    end if
    if (present(shape)) then
      if (present(failure)) failure = 'shape has another shape than size(master) x size(number)'
      if (nmaster < 1 .or. size(shape, 1) /= nmaster .or. size(shape, 2) /= nmode) return
      c_shape = shape
      measured%shape = c_loc(c_shape)
    end if
    if (present(shape_std)) then
      if (present(failure)) failure = 'shape_std has another shape than size(master) x size(number)'
      if (nmaster < 1 .or. size(shape_std, 1) /= nmaster .or. size(shape_std, 2) /= nmode) return
      c_shape_std = shape_std
      measured%shape_std = c_loc(c_shape_std)
    end if
    if (present(holdout)) then
      if (present(failure)) failure = 'holdout has another size than number'
      if (size(holdout) /= nmode) return
      c_holdout = merge(1_c_int, 0_c_int, holdout)
      measured%holdout = c_loc(c_holdout)
    end if

    if (present(options)) how = options
    how%size = c_sizeof(how)
    status = rotid_fit(host, parameter, measured, how, c_loc(given), c_loc(why), c_fit)
    if (present(failure)) failure = rotid_string(c_loc(why))
    if (c_associated(c_fit)) call c_f_pointer(c_fit, fit)
  end function rotid_fit_model

  ! ---- rotid_free

  subroutine free_deck(deck)
    type(rotid_deck), pointer, intent(inout) :: deck
    if (associated(deck)) call rotid_deck_free(c_loc(deck))
    nullify (deck)
  end subroutine free_deck

  subroutine free_check(check)
    type(rotid_check), pointer, intent(inout) :: check
    if (associated(check)) call rotid_check_free(c_loc(check))
    nullify (check)
  end subroutine free_check

  subroutine free_spectrum(spectrum)
    type(rotid_spectrum), pointer, intent(inout) :: spectrum
    if (associated(spectrum)) call rotid_spectrum_free(c_loc(spectrum))
    nullify (spectrum)
  end subroutine free_spectrum

  subroutine free_identification(found)
    type(rotid_identification), pointer, intent(inout) :: found
    if (associated(found)) call rotid_identification_free(c_loc(found))
    nullify (found)
  end subroutine free_identification

  subroutine free_diagnosis(found)
    type(rotid_diagnosis), pointer, intent(inout) :: found
    if (associated(found)) call rotid_diagnosis_free(c_loc(found))
    nullify (found)
  end subroutine free_diagnosis

  subroutine free_suggestion(found)
    type(rotid_suggestion), pointer, intent(inout) :: found
    if (associated(found)) call rotid_suggestion_free(c_loc(found))
    nullify (found)
  end subroutine free_suggestion

  subroutine free_speeds(found)
    type(rotid_speeds), pointer, intent(inout) :: found
    if (associated(found)) call rotid_speeds_free(c_loc(found))
    nullify (found)
  end subroutine free_speeds

  subroutine free_fit(fit)
    type(rotid_fit_result), pointer, intent(inout) :: fit
    if (associated(fit)) call rotid_fit_free(c_loc(fit))
    nullify (fit)
  end subroutine free_fit

  ! ---- inside

  pure function c_string(string) result(text)
    character(len=*), intent(in) :: string
    character(kind=c_char) :: text(len_trim(string) + 1)
    integer :: i
    do i = 1, len_trim(string)
      text(i) = string(i:i)
    end do
    text(size(text)) = c_null_char
  end function c_string

  ! Texts for C and their addresses, one more than there are texts.
  subroutine c_strings(string, text, pointers)
    character(len=*), intent(in), optional :: string(:)
    character(kind=c_char), allocatable, target, intent(out) :: text(:, :)
    type(c_ptr), allocatable, intent(out) :: pointers(:)
    integer :: i
    if (.not. present(string)) then
      pointers = [c_null_ptr]
      return
    end if
    allocate (text(len(string) + 1, max(1, size(string))), pointers(size(string) + 1))
    do i = 1, size(string)
      text(1:len_trim(string(i)) + 1, i) = c_string(string(i))
      pointers(i) = c_loc(text(1, i))
    end do
    pointers(size(pointers)) = c_null_ptr
  end subroutine c_strings

  pure function ones_to_zeros(index) result(from_zero)
    integer, intent(in) :: index(:)
    integer(c_int) :: from_zero(size(index))
    from_zero = int(max(index, 0) - 1, c_int) ! none lies below the lowest integer
  end function ones_to_zeros

end module rotid
