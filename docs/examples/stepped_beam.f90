! A beam solver in Fortran lets rotid find two of its parameters: Young's modulus of the middle section of a stepped shaft, and the
! stiffness of the bearing at its right end. The left end is clamped.
module beam_solver
  use rotid
  implicit none

  integer, parameter :: dp = c_double
  real(dp), parameter :: pi = 3.141592653589793_dp

  type section
    real(dp) :: length, diameter, density, young ! m, m, kg/m3, Pa
    integer :: elements
  end type section

  ! What the callbacks need to know; they get its address as `user`, so that nothing is global.
  type shaft
    type(section) :: section(3)
  end type shaft

contains

  ! Stiffness and mass of an Euler-Bernoulli element for (v1, v1', v2, v2').
  subroutine element(ei, rho_s, l, stiffness, mass)
    real(dp), intent(in) :: ei, rho_s, l
    real(dp), intent(out) :: stiffness(4, 4), mass(4, 4)
    stiffness = ei / l**3 * reshape([12.0_dp, 6 * l, -12.0_dp, 6 * l, &
                                     6 * l, 4 * l**2, -6 * l, 2 * l**2, &
                                     -12.0_dp, -6 * l, 12.0_dp, -6 * l, &
                                     6 * l, 2 * l**2, -6 * l, 4 * l**2], [4, 4])
    mass = rho_s * l / 420 * reshape([156.0_dp, 22 * l, 54.0_dp, -13 * l, &
                                      22 * l, 4 * l**2, 13 * l, -3 * l**2, &
                                      54.0_dp, 13 * l, 156.0_dp, -22 * l, &
                                      -13 * l, -3 * l**2, -22 * l, 4 * l**2], [4, 4])
  end subroutine element

  ! Degrees of freedom of element e, from 1: 0 is held, as both of the clamped node are.
  pure function element_dof(e) result(dof)
    integer, intent(in) :: e
    integer :: dof(4)
    dof = max(0, [2 * e - 3, 2 * e - 2, 2 * e - 1, 2 * e])
  end function element_dof

  ! K(x) and M(x): x(1) is Young's modulus of the middle section, x(2) the stiffness of the bearing.
  function matrices(user, x, stiffness, mass) result(failure) bind(C)
    type(c_ptr), value :: user
    real(dp), intent(in) :: x(*)
    type(rotid_matrix), intent(inout), target :: stiffness, mass
    integer(c_int) :: failure
    type(shaft), pointer :: rotor
    real(dp), pointer :: band(:, :)
    real(dp) :: k(4, 4), m(4, 4), young
    integer :: s, i, e
    call c_f_pointer(user, rotor)
    e = 0
    do s = 1, 3
      associate (part => rotor%section(s))
        young = merge(x(1), part%young, s == 2)
        call element(young * pi * part%diameter**4 / 64, part%density * pi * part%diameter**2 / 4, &
                     part%length / part%elements, k, m)
        do i = 1, part%elements
          e = e + 1
          failure = rotid_add_element(stiffness, element_dof(e), k)
          if (failure /= ROTID_OK) return
          failure = rotid_add_element(mass, element_dof(e), m)
          if (failure /= ROTID_OK) return
        end do
      end associate
    end do
    ! or straight into the packed band: A(i, j) is band(1 + i - j, j) for i >= j
    band => rotid_band(stiffness)
    band(1, 2 * e - 1) = band(1, 2 * e - 1) + x(2)
  end function matrices

  ! dK/dx(p + 1); the mass depends on neither parameter and stays zero.
  function derivatives(user, x, p, stiffness, mass) result(failure) bind(C)
    type(c_ptr), value :: user
    real(dp), intent(in) :: x(*)
    integer(c_int), value :: p
    type(rotid_matrix), intent(inout), target :: stiffness, mass
    integer(c_int) :: failure
    type(shaft), pointer :: rotor
    real(dp) :: k(4, 4), m(4, 4)
    integer :: e
    call c_f_pointer(user, rotor)
    failure = ROTID_OK
    if (p == 0) then
      associate (first => rotor%section(1)%elements, part => rotor%section(2))
        call element(pi * part%diameter**4 / 64, 0.0_dp, part%length / part%elements, k, m)
        do e = first + 1, first + part%elements
          failure = rotid_add_element(stiffness, element_dof(e), k)
          if (failure /= ROTID_OK) return
        end do
      end associate
    else
      failure = rotid_add(stiffness, int(stiffness%n) - 1, int(stiffness%n) - 1, 1.0_dp)
    end if
  end function derivatives

end module beam_solver

program stepped_beam
  use beam_solver
  implicit none

  type(shaft), target :: rotor = shaft([section(0.30_dp, 0.040_dp, 7850, 2.1e11_dp, 6), &
                                        section(0.50_dp, 0.060_dp, 7700, 0, 10), &
                                        section(0.25_dp, 0.035_dp, 7850, 2.1e11_dp, 5)])

  ! What was measured: four modes at the nodes 0.15, 0.30, 0.45, 0.65, 0.85 and 1.05 m, where each mode has a free scale and sign.
  ! Not from this program: these are the roots of the characteristic equation of the stepped Euler-Bernoulli beam for E = 1.2e11 Pa
  ! and a bearing of 8e5 N/m, by transfer matrices in 40 digits, with Gaussian noise of 0.05 % of each frequency and 1 % of the
  ! largest component of each shape.
  integer, parameter :: sensor_node(6) = [3, 6, 9, 13, 17, 21]
  real(dp), parameter :: hz(4) = [66.50_dp, 220.89_dp, 481.03_dp, 908.82_dp]
  real(dp), parameter :: shapes(6, 4) = 0.001_dp * reshape([109, 324, 552, 828, 1000, 928, &
                                                                        -160, -360, -368, -99, 393, 981, &
                                                                        209, 342, 123, -229, -109, 998, &
                                                                        -474, -412, 242, 139, -555, 996], [6, 4])
  real(dp), parameter :: hz_std(4) = 0.0005_dp, shape_std(6, 4) = 0.01_dp

  type(rotid_model), target :: model
  type(rotid_parameter) :: parameter(2)
  type(rotid_fit_options) :: options
  type(rotid_fit_result), pointer :: fit
  character(len=:), allocatable, save :: failure
  real(dp), pointer :: x(:), lower(:), upper(:), predicted(:)
  integer(c_int) :: status
  integer :: i

  model%n = 2 * sum(rotor%section%elements)
  model%kd = 3
  model%matrices = c_funloc(matrices)
  model%derivatives = c_funloc(derivatives)
  model%user = c_loc(rotor)
  parameter(1) = rotid_parameter(lower=1e9_dp, upper=1e12_dp, start=2.1e11_dp)
  parameter(2) = rotid_parameter(lower=1e4_dp, upper=1e8_dp, start=2e6_dp)
  options%functional = ROTID_LIKELIHOOD

  status = rotid_fit_model(model, parameter, [1, 2, 3, 4], hz, fit, frequency_std=hz_std, shape=shapes, shape_std=shape_std, &
                           master=2 * sensor_node - 1, options=options, failure=failure)
  if (status < 0) then
    print '(2a)', 'failed: ', failure
    error stop 1
  end if

  x => rotid_reals(fit%x, fit%n)
  lower => rotid_reals(fit%ci_lower, fit%n)
  upper => rotid_reals(fit%ci_upper, fit%n)
  predicted => rotid_reals(fit%predicted_hz, fit%m)
  if (fit%converged == 0) print '(2a)', 'not converged: ', rotid_status_message(fit%status)
  print '(a,es12.5,a,es12.5,a,es12.5,a)', 'E ', x(1), ' Pa,   95 % interval ', lower(1), ' ... ', upper(1)
  print '(a,es12.5,a,es12.5,a,es12.5,a)', 'k ', x(2), ' N/m,  95 % interval ', lower(2), ' ... ', upper(2)
  do i = 1, fit%m
    print '(a,i0,a,f8.2,a,f8.2,a)', 'mode ', i, ': measured ', hz(i), ' Hz, model ', predicted(i), ' Hz'
  end do
  call rotid_free(fit)
end program stepped_beam
