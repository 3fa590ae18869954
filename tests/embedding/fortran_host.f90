! A Fortran host that calls everything that rotid.f90 has for Fortran, and routines of each layer as they are in C. What comes back
! is compared with closed forms; every miss is printed, and the last line counts the checks.
!
! fortran_host GOOD.inp BAD.inp: a deck whose truth is E = 1.1e11 and G = 4e10 Pa, and one with errors.
module callbacks
  use, intrinsic :: iso_c_binding, only: c_double, c_int, c_size_t, c_ptr, c_f_pointer, c_associated
  use rotid
  implicit none

  integer, parameter :: dp = c_double
  integer :: checks = 0, misses = 0

  ! what callbacks count
  type ledger
    integer :: taken = 0, returned = 0, models = 0
  end type ledger

  interface
    function malloc(bytes) result(block) bind(C, name="malloc")
      import :: c_size_t, c_ptr
      integer(c_size_t), value :: bytes
      type(c_ptr) :: block
    end function malloc
    subroutine free(block) bind(C, name="free")
      import :: c_ptr
      type(c_ptr), value :: block
    end subroutine free
  end interface

contains

  ! The operands of .and. may be evaluated in any order: what a call leaves behind is checked in a statement of its own.
  subroutine check(good, what)
    logical, intent(in) :: good
    character(len=*), intent(in) :: what
    checks = checks + 1
    if (good) return
    misses = misses + 1
    print '(2a)', 'not so: ', what
  end subroutine check

  logical function close_to(value, expected, tolerance)
    real(dp), intent(in) :: value, expected, tolerance
    close_to = abs(value - expected) <= tolerance * max(abs(expected), 1.0_dp)
  end function close_to

  ! Three masses of 1 kg: the outer ones on springs x(1), joined across the middle one by x(2); the middle one on one of 50 N/m.
  ! (rad/s)^2: x(1) for (1, 0, 1), x(1) + 2 x(2) for (1, 0, -1), 50 for (0, 1, 0).
  function bridge(user, x, stiffness, mass) result(failure) bind(C)
    type(c_ptr), value :: user
    real(dp), intent(in) :: x(*)
    type(rotid_matrix), intent(inout), target :: stiffness, mass
    integer(c_int) :: failure
    integer :: i
    real(dp), pointer :: band(:, :), block(:, :)
    type(ledger), pointer :: account
    call c_f_pointer(user, account)
    account%models = account%models + 1
    failure = ROTID_OK
    do i = 1, 3
      failure = ior(failure, rotid_add(mass, i, i, 1.0_dp))
      failure = ior(failure, rotid_add(stiffness, i, i, merge(50.0_dp, x(1), i == 2)))
    end do
    failure = ior(failure, rotid_add_element(stiffness, [1, 3], x(2) * reshape([1.0_dp, -1.0_dp, -1.0_dp, &
                                                                               1.0_dp], [2, 2])))
    band => rotid_band(stiffness)
    block => rotid_block(stiffness)
    if (any(shape(band) /= [2, 3]) .or. any(shape(block) /= [2, 2])) failure = 1
    if (failure /= ROTID_OK) return
    if (band(1, 2) /= 50 .or. block(1, 2) /= -x(2) .or. block(2, 1) /= -x(2)) failure = 1
  end function bridge

  ! x1 exp(-x2 t) - 2 exp(-0.7 t) at t = 0, 1/4, ...
  function decay(user, m, n, x, r, jacobian) result(failure) bind(C)
    type(c_ptr), value :: user
    integer(c_int), value :: m, n
    real(dp), intent(in) :: x(*)
    type(c_ptr), value :: r, jacobian
    integer(c_int) :: failure
    real(dp), pointer :: residual(:), derivative(:, :)
    real(dp) :: t(m)
    integer :: i
    failure = merge(1_c_int, 0_c_int, c_associated(user))
    t = [(0.25_dp * (i - 1), i=1, m)]
    residual => rotid_reals(r, m)
    derivative => rotid_reals(jacobian, m, n)
    if (associated(residual)) residual = x(1) * exp(-x(2) * t) - 2 * exp(-0.7_dp * t)
    if (associated(derivative)) then
      derivative(:, 1) = exp(-x(2) * t)
      derivative(:, 2) = -t * x(1) * exp(-x(2) * t)
    end if
  end function decay

  function stop_at_once(context) result(stop) bind(C)
    type(c_ptr), value :: context
    integer(c_int) :: stop
    stop = merge(0_c_int, 1_c_int, c_associated(context))
  end function stop_at_once

  function take(context, bytes) result(block) bind(C)
    type(c_ptr), value :: context
    integer(c_size_t), value :: bytes
    type(c_ptr) :: block
    type(ledger), pointer :: account
    call c_f_pointer(context, account)
    account%taken = account%taken + 1
    block = malloc(bytes)
  end function take

  subroutine give_back(context, block) bind(C)
    type(c_ptr), value :: context, block
    type(ledger), pointer :: account
    call c_f_pointer(context, account)
    account%returned = account%returned + 1
    call free(block)
  end subroutine give_back

end module callbacks

program fortran_host
  use callbacks
  implicit none
  character(len=1000) :: good, bad
  call get_command_argument(1, good)
  call get_command_argument(2, bad)
  call texts()
  call matrices()
  call blocks()
  call models()
  call states()
  call decks(trim(good), trim(bad))
  print '(i0,a,i0,a)', checks, ' checks, ', misses, ' misses'
  if (misses > 0) error stop 1

contains

  subroutine texts()
    type(rotid_message), target :: message
    character(kind=c_char), target :: file(8), text(8)
    file = [character(kind=c_char) :: 'a', ' ', 'b', '.', 'i', 'n', 'p', c_null_char]
    text = [character(kind=c_char) :: 'w', 'r', 'o', 'n', 'g', ' ', 'x', c_null_char]
    call check(rotid_string(rotid_version()) == ROTID_VERSION_TEXT, 'the version')
    call check(rotid_status_message(ROTID_ERROR_MEMORY) == 'out of memory', 'the text of a status')
    call check(rotid_string(rotid_status_name(ROTID_STOP_STEP)) == 'ROTID_STOP_STEP', 'the name of a status')
    call check(rotid_string(rotid_verdict_name(ROTID_NAMED)) == 'named', 'the name of a verdict')
    call check(len(rotid_string(c_null_ptr)) == 0, 'no text')
    message = rotid_message(severity=ROTID_WARNING, line=12, column=3, file=c_loc(file), text=c_loc(text))
    call check(rotid_message_text(message) == 'a b.inp:12:3: warning: wrong x', 'a message with its place')
    message = rotid_message(severity=ROTID_ERROR, text=c_loc(text))
    call check(rotid_message_text(message) == 'error: wrong x', 'a message without a place')
  end subroutine texts

  subroutine matrices()
    real(dp), target :: band(2, 4), block(2, 2)
    integer(c_int), target :: far(2) = [0, 3]
    real(dp) :: full(4, 4), back(4, 4), x(4, 1), y(4, 1)
    type(rotid_matrix) :: a
    character(len=:), allocatable :: failure
    band = 0
    block = 0
    a = rotid_matrix(n=4, kd=1, nfar=2, far=c_loc(far), band=c_loc(band), block=c_loc(block))
    full = reshape([5.0_dp, -1.0_dp, 0.0_dp, -7.0_dp, &
                    -1.0_dp, 6.0_dp, -2.0_dp, 0.0_dp, &
                    0.0_dp, -2.0_dp, 3.0_dp, -4.0_dp, &
                    -7.0_dp, 0.0_dp, -4.0_dp, 9.0_dp], [4, 4])
    call check(rotid_set_full(a, full) == ROTID_OK, 'a dense matrix is taken')
    call check(band(1, 2) == 6 .and. band(2, 3) == -4 .and. block(1, 2) == -7 .and. block(2, 1) == -7, 'band and block')
    call check(rotid_matrix_get_dense(a, back, 4_c_int, c_null_ptr) == ROTID_OK, 'a dense matrix is given')
    call check(all(back == full), 'a dense matrix there and back')
    full(3, 1) = 1
    full(1, 3) = 1
    call check(rotid_set_full(a, full, failure) == ROTID_ERROR_ARGUMENT, 'an entry without a place')
    call check(index(failure, 'entry (2, 0) lies outside the band') == 1, 'which entry, from 0')
    call check(rotid_set_full(a, full(1:3, 1:3), failure) == ROTID_ERROR_ARGUMENT, 'a dense matrix of another size')
    call check(index(failure, 'full has another shape') == 1, 'that it is the size')
    call check(rotid_add(a, 1, 3, 1.0_dp, failure) == ROTID_ERROR_ARGUMENT, 'no place')
    call check(index(failure, 'entry (0, 2) lies outside the band') == 1, 'which place')
    call check(rotid_add(a, 0, 1, 1.0_dp) == ROTID_ERROR_ARGUMENT, 'no row 0')
    call check(rotid_add(a, -huge(1) - 1, 1, 1.0_dp, failure) == ROTID_ERROR_ARGUMENT, 'no row of the least integer')
    call check(index(failure, '-1') > 0, 'nor one that it would wrap to')
    call check(rotid_add(a, 4, 1, 0.5_dp, failure) == ROTID_OK, 'A(4, 1)')
    call check(failure == '', 'nothing to say of it')
    call check(block(1, 2) == -6.5_dp .and. block(2, 1) == -6.5_dp, 'where A(4, 1) goes')
    ! the second of three is held
    call check(rotid_add_element(a, [-huge(1) - 1, -1], full(1:2, 1:2)) == ROTID_OK, 'an element whose ends are held')
    call check(rotid_add_element(a, [2, 0, 3], reshape([1.0_dp, 99.0_dp, 2.0_dp, 99.0_dp, 99.0_dp, &
                                                       99.0_dp, 2.0_dp, 99.0_dp, 3.0_dp], [3, 3])) &
               == ROTID_OK, 'an element')
    call check(band(1, 2) == 7 .and. band(2, 2) == 0 .and. band(1, 3) == 6, 'where an element goes')
    call check(rotid_add_element(a, [1, 2, 3], full(1:2, 1:2), failure) == ROTID_ERROR_ARGUMENT, 'an element of another size')
    call check(index(failure, 'e has another shape') == 1, 'that it is e')
    x(:, 1) = [1, 0, 0, 0]
    call check(rotid_matrix_multiply(a, 1_c_int, x, y, c_null_ptr) == ROTID_OK, 'a product')
    call check(all(y(:, 1) == [5.0_dp, -1.0_dp, 0.0_dp, -6.5_dp]), 'A x')
  end subroutine matrices

  subroutine blocks()
    real(dp), target :: k(2, 3) = reshape([2, -1, 2, -1, 1, 0], [2, 3]), m(2, 3) = reshape([1, 0, 1, 0, 1, 0], [2, 3])
    real(dp), target :: dk(2, 3) = reshape([1, 0, 0, 0, 0, 0], [2, 3]), dm(2, 3) = 0, scale(2) = 1
    type(rotid_matrix) :: stiffness, mass, dstiffness, dmass
    real(dp) :: kc(2, 2), mc(2, 2), lambda(3), phi(3, 3), dlambda, theta, x(2), r(12), jacobian(12, 2), error(2), doubt(2)
    real(dp) :: e(4, 4), outer, inner
    real(dp), target :: t(3, 2), dphi(3)
    character(kind=c_char), target :: why(ROTID_FAILURE_LENGTH)
    real(dp), allocatable :: work(:)
    type(rotid_lm_result) :: result
    integer :: i
    real(dp), parameter :: pi = acos(-1.0_dp)
    stiffness = rotid_matrix(n=3, kd=1, band=c_loc(k))
    mass = rotid_matrix(n=3, kd=1, band=c_loc(m))
    dstiffness = rotid_matrix(n=3, kd=1, band=c_loc(dk))
    dmass = rotid_matrix(n=3, kd=1, band=c_loc(dm))
    ! a chain of three masses, the first held by a spring: omega = 2 sin((2 i - 1) pi/14)
    call check(rotid_eigenpairs(stiffness, mass, 3_c_int, c_null_ptr, c_null_ptr, lambda, phi) == ROTID_OK, 'eigenpairs')
    do i = 1, 3
      theta = (2 * i - 1) * pi / 14
      call check(close_to(lambda(i), (2 * sin(theta))**2, 1e-12_dp), 'an eigenvalue')
    end do
    call check(rotid_eigenpair_derivative(stiffness, mass, dstiffness, dmass, 3_c_int, lambda, phi, 1_c_int, c_null_ptr, &
                                          c_null_ptr, dlambda, c_loc(dphi)) == ROTID_OK, 'the derivative of a pair')
    call check(close_to(dlambda, phi(1, 2)**2, 1e-12_dp), 'phi'' dK phi')
    call check(abs(dot_product(dphi, phi(:, 2))) < 1e-10_dp, 'phi'' M dphi')
    ! the middle mass condensed: half of it on either side
    call check(rotid_condense(stiffness, mass, 2_c_int, [0_c_int, 2_c_int], ROTID_GUYAN, c_null_ptr, c_null_ptr, kc, mc, c_loc(t)) &
               == ROTID_OK, 'a condensation')
    call check(close_to(kc(1, 1), 1.5_dp, 1e-14_dp) .and. close_to(kc(1, 2), -0.5_dp, 1e-14_dp) .and. &
               close_to(kc(2, 2), 0.5_dp, 1e-14_dp), 'the condensed stiffness')
    call check(close_to(mc(1, 1), 1.25_dp, 1e-14_dp) .and. close_to(mc(2, 1), 0.25_dp, 1e-14_dp), &
               'the condensed mass')
    call check(close_to(t(2, 1), 0.5_dp, 1e-14_dp) .and. close_to(t(3, 2), 1.0_dp, 1e-14_dp), 'T')
    call check(rotid_condense_derivative(stiffness, mass, dstiffness, dmass, 2_c_int, [0_c_int, 2_c_int], ROTID_GUYAN, c_null_ptr, &
                                         c_null_ptr, kc, mc) == ROTID_OK, 'the derivative of a condensation')
    call check(close_to(kc(1, 1), 1.0_dp, 1e-14_dp) .and. abs(kc(2, 2)) < 1e-14_dp, 'its stiffness')

    allocate (work(max(rotid_lm_workspace(12_c_int, 2_c_int), rotid_check_jacobian_workspace(12_c_int, 2_c_int))))
    x = [1.0_dp, 0.3_dp]
    call check(rotid_check_jacobian(12_c_int, 2_c_int, c_funloc(decay), c_null_ptr, x, c_loc(scale), c_null_ptr, error, &
                                    doubt, work) &
               == ROTID_OK, 'a check of a Jacobian')
    call check(all(error < 1e-8_dp), 'the Jacobian')
    call check(rotid_lm(12_c_int, 2_c_int, c_funloc(decay), c_null_ptr, c_null_ptr, c_null_ptr, x, r, jacobian, &
                        work, result) > 0, 'rotid_lm')
    call check(rotid_lm(0_c_int, 2_c_int, c_funloc(decay), c_null_ptr, c_null_ptr, c_loc(why), x, r, jacobian, work, result) &
               == ROTID_ERROR_ARGUMENT, 'no residuals')
    call check(rotid_string(c_loc(why)) == 'm is 0 and n is 2, expected 1 or more', 'which argument it is')
    call check(close_to(x(1), 2.0_dp, 1e-9_dp) .and. close_to(x(2), 0.7_dp, 1e-9_dp), 'the minimum')
    call check(close_to(jacobian(3, 1), exp(-0.35_dp), 1e-8_dp), 'the Jacobian at the minimum')

    call check(close_to(rotid_mac(2_c_int, [1.0_dp, 1.0_dp], [1.0_dp, 0.0_dp]), 0.5_dp, &
                        1e-15_dp), 'MAC')
    call check(close_to(rotid_nco(2_c_int, reshape([1.0_dp, 0.0_dp, 0.0_dp, 3.0_dp], [2, 2]), &
                                  [1.0_dp, 1.0_dp], [1.0_dp, 0.0_dp], work), 0.25_dp, &
                        1e-15_dp), 'NCO')
    call rotid_element_stiffness(2.0_dp, 1e30_dp, 1.0_dp, e)
    call check(close_to(e(1, 1), 24.0_dp, 1e-12_dp) .and. close_to(e(4, 2), 4.0_dp, 1e-12_dp), 'an element')
    call check(rotid_equivalent_cylinder(pi / 4 * 3, pi / 64 * 15, c_null_ptr, outer, inner) == ROTID_OK, 'a cylinder')
    call check(close_to(outer, 2.0_dp, 1e-12_dp) .and. close_to(inner, 1.0_dp, 1e-12_dp), 'its diameters')
  end subroutine blocks

  subroutine models()
    real(dp), parameter :: two_pi = 2 * acos(-1.0_dp)
    real(dp) :: hz(2), shapes(2, 2), error(4), doubt(4)
    integer(c_int), target :: far(2)
    type(rotid_model), target :: model
    type(rotid_parameter) :: parameter(2)
    type(rotid_fit_options) :: options
    type(rotid_fit_result), pointer :: fit
    type(rotid_environment), target :: environment
    type(rotid_allocator), target :: allocator
    type(ledger), target :: account
    real(dp), pointer :: x(:), y(:)
    integer(c_int) :: status
    character(len=:), allocatable :: failure
    hz = sqrt([1.0_dp, 5.0_dp]) / two_pi
    shapes = reshape([1, 1, 1, -1], [2, 2])
    model = rotid_model(n=3, kd=1, matrices=c_funloc(bridge), user=c_loc(account))
    parameter(1) = rotid_parameter(lower=0.01_dp, upper=100.0_dp, start=3.0_dp)
    parameter(2) = rotid_parameter(lower=0.01_dp, upper=100.0_dp, start=0.8_dp)
    options%functional = ROTID_LIKELIHOOD
    far = [0, 2]
    model%nfar = 2
    model%far = c_loc(far)
    model%nparam = 2
    status = rotid_check_model(model, parameter, c_null_ptr, c_null_ptr, c_null_ptr, error, doubt)
    call check(status == ROTID_OK .and. all(error < 1e-7_dp), 'a check of a model')
    account = ledger()
    allocator = rotid_allocator(allocate=c_funloc(take), release=c_funloc(give_back), context=c_loc(account))
    environment%allocator = c_loc(allocator)
    status = rotid_fit_model(model, parameter, [1, 2], hz, fit, frequency_std=[0.01_dp, 0.01_dp], shape=shapes, &
                             shape_std=0.02_dp + 0 * shapes, master=[1, 3], far=[1, 3], options=options, &
                             environment=environment)
    call check(status == ROTID_OK .and. associated(fit), 'a fit')
    if (.not. associated(fit)) return
    x => rotid_reals(fit%x, fit%n)
    y => rotid_reals(fit%mac, fit%m)
    call check(close_to(x(1), 1.0_dp, 1e-7_dp) .and. close_to(x(2), 2.0_dp, 1e-7_dp), 'what it found')
    call check(fit%nresidual == 6 .and. fit%converged /= 0 .and. all(y > 0.999999_dp), 'with the shapes')
    call check(account%taken > 0 .and. account%returned < account%taken, 'the allocator of the host')
    call check(account%models >= fit%evaluations, 'what the callback counted')
    call rotid_free(fit)
    call check(.not. associated(fit) .and. account%returned == account%taken, 'what it got back')
    call rotid_free(fit)

    status = rotid_fit_model(model, parameter, [1, 2], hz, fit, frequency_std=[0.01_dp, 0.01_dp], far=[1, 3], &
                             holdout=[.true., .false.], options=options)
    call check(status == ROTID_OK .and. associated(fit), 'a fit with a mode held out')
    if (associated(fit)) call check(fit%nresidual == 1 .and. fit%m == 2 .and. fit%any_undetermined /= 0, 'a mode held out')
    call rotid_free(fit)

    environment = rotid_environment(cancelled=c_funloc(stop_at_once))
    status = rotid_fit_model(model, parameter, [1, 2], hz, fit, far=[1, 3], environment=environment, &
                             options=rotid_fit_options(functional=ROTID_HYBRID))
    call check(status == ROTID_OK .and. associated(fit), 'a cancelled fit')
    if (associated(fit)) call check(fit%status == ROTID_STOP_CANCELLED, 'that it was cancelled')
    call rotid_free(fit)

    call check(rotid_fit_model(model, parameter, [1, 2], hz(1:1), fit, far=[1, 3], failure=failure) == ROTID_ERROR_ARGUMENT, &
               'a frequency too few')
    call check(index(failure, 'frequency_hz has another size') > 0, 'that it is the frequencies')
    call check(rotid_fit_model(model, parameter, [1, 0], hz, fit, far=[1, 3], failure=failure) == ROTID_ERROR_ARGUMENT, &
               'no mode 0')
    call check(failure == 'measured->number[1] is 0, expected a mode of the model, from 1', 'which number it is')
    call check(rotid_fit_model(model, parameter, [1, 2], hz, fit, far=[1, 3], frequency_std=hz(1:1)) == ROTID_ERROR_ARGUMENT, &
               'a standard deviation too few')
    call check(rotid_fit_model(model, parameter, [1, 2], hz, fit, far=[1, 3], shape=shapes) == ROTID_ERROR_ARGUMENT, &
               'shapes without masters')
    call check(rotid_fit_model(model, parameter, [1, 2], hz, fit, far=[1, 3], shape=shapes, master=[1]) == ROTID_ERROR_ARGUMENT, &
               'shapes with a master too few')
    call check(rotid_fit_model(model, parameter, [1, 2], hz, fit, far=[1, 3], shape=shapes, master=[0, 3]) &
               == ROTID_ERROR_ARGUMENT, 'masters from 0')
    call check(rotid_fit_model(model, parameter, [1, 2], hz, fit, far=[1, 3], shape=shapes, master=[-huge(1) - 1, 3], &
                               failure=failure) == ROTID_ERROR_ARGUMENT, 'the lowest master')
    call check(failure == 'master[0] is -1, expected 0 ... 2', 'where the lowest master is')
    call check(rotid_fit_model(model, parameter, [1, 2], hz, fit, options=rotid_fit_options(functional=ROTID_HYBRID)) &
               == ROTID_ERROR_CALLBACK, 'a callback that fails')
    call check(.not. associated(fit), 'no result of it')
  end subroutine models

  ! Mode 1 is of the first spring alone, mode 2 of both: a state each, and the unknowns the other way round.
  subroutine states()
    real(dp), parameter :: two_pi = 2 * acos(-1.0_dp)
    integer(c_int), target :: far(2), swapped(2), number(2)
    real(dp), target :: hz(2), std(1)
    type(rotid_model), target :: model
    type(rotid_measured), target :: measured(2)
    type(rotid_state) :: state(2)
    type(rotid_parameter) :: parameter(2)
    type(rotid_fit_options) :: options
    type(rotid_fit_result), pointer :: fit
    type(ledger), target :: account
    type(c_ptr) :: result
    real(dp), pointer :: x(:)
    integer(c_int), pointer :: modes(:)
    integer :: s
    far = [0, 2]
    swapped = [1, 0]
    number = [1, 2]
    hz = sqrt([1.0_dp, 5.0_dp]) / two_pi
    std = 0.01_dp
    model = rotid_model(n=3, kd=1, nfar=2, far=c_loc(far), nparam=2, matrices=c_funloc(bridge), user=c_loc(account))
    parameter = rotid_parameter(lower=0.01_dp, upper=100.0_dp, start=3.0_dp)
    options%functional = ROTID_LIKELIHOOD
    do s = 1, 2
      measured(s) = rotid_measured(nmode=1, number=c_loc(number(s)), frequency_hz=c_loc(hz(s)), frequency_std=c_loc(std))
      state(s) = rotid_state(model=c_loc(model), measured=c_loc(measured(s)), parameter=c_loc(swapped))
    end do
    call check(rotid_fit_states(2_c_int, state, 2_c_int, parameter, options, c_null_ptr, c_null_ptr, result) == ROTID_OK, &
               'a fit over states')
    if (.not. c_associated(result)) return
    call c_f_pointer(result, fit)
    x => rotid_reals(fit%x, fit%n)
    modes => rotid_integers(fit%state_m, fit%nstate)
    call check(close_to(x(2), 1.0_dp, 1e-7_dp) .and. close_to(x(1), 2.0_dp, 1e-7_dp), 'what both states say together')
    call check(all(modes == 1) .and. fit%m == 2 .and. fit%any_undetermined == 0, 'a mode of each state')
    call rotid_free(fit)
  end subroutine states

  subroutine decks(good, bad)
    character(len=*), intent(in) :: good, bad
    type(rotid_deck), pointer :: deck
    type(rotid_spectrum), pointer :: spectrum
    type(rotid_identification), pointer :: found
    type(rotid_diagnosis), pointer :: diagnosis
    type(rotid_fit_result), pointer :: fit
    type(rotid_message), pointer :: message(:)
    type(rotid_environment), target :: environment
    type(rotid_check), pointer :: checked
    type(rotid_model_mode), pointer :: modes(:)
    real(dp), pointer :: x(:), at_start(:)
    integer(c_int), pointer :: held(:)
    character(len=:), allocatable :: failure
    integer(c_int) :: status
    call check(rotid_read_deck(good, deck) == ROTID_OK, 'a deck')
    if (.not. associated(deck)) return
    call check(deck%nmode == 4 .and. deck%nparameter == 2 .and. deck%nerror == 0, 'what it says')
    call check(rotid_string(deck%path) == good, 'its path')
    held => rotid_integers(deck%holdout, deck%nmode)
    call check(all(held == 0), 'nothing held out')
    call check(rotid_check_deck(deck, checked) == ROTID_OK .and. associated(checked), 'a check')
    if (associated(checked)) call check(abs(checked%mass_kg / deck%mass - 1) < 1e-12_dp, 'its mass')
    call rotid_free(checked)
    call check(rotid_compute_spectrum(deck, 3, spectrum, x=[1.1e11_dp, 4e10_dp]) == ROTID_OK, 'a spectrum')
    at_start => rotid_reals(deck%frequency_hz, deck%nmode)
    call c_f_pointer(spectrum%modes, modes, [spectrum%nmodes])
    call check(spectrum%nmodes == 3 .and. all(abs(modes%full_hz / at_start(1:3) - 1) < 1e-4_dp), 'its frequencies at the truth')
    call rotid_free(spectrum)
    call check(rotid_compute_spectrum(deck, 3, spectrum) == ROTID_OK, 'a spectrum at the start')
    call c_f_pointer(spectrum%modes, modes, [spectrum%nmodes])
    call check(all(abs(modes%full_hz / at_start(1:3) - 1) > 1e-3_dp), 'its frequencies at the start')
    call rotid_free(spectrum)
    call check(rotid_compute_spectrum(deck, 3, spectrum, x=[1e11_dp], failure=failure) == ROTID_ERROR_ARGUMENT, &
               'a value too few')
    call check(index(failure, 'x has another size') == 1, 'that it is x')
    status = rotid_identify_deck(deck, found, failure=failure)
    call check(status == ROTID_OK .and. associated(found) .and. failure == '', 'an identification')
    if (associated(found)) then
      call c_f_pointer(found%fit, fit)
      x => rotid_reals(fit%x, fit%n)
      call check(abs(x(1) / 1.1e11_dp - 1) < 1e-3_dp .and. abs(x(2) / 4e10_dp - 1) < 1e-2_dp, 'the moduli')
      call check(fit%nbaseline == 0, 'no baseline')
    end if
    call rotid_free(found)
    environment%cancelled = c_funloc(stop_at_once)
    status = rotid_diagnose_deck(deck, diagnosis, options=rotid_diagnose_options(threads=1), environment=environment, &
                                 failure=failure)
    call check(status == ROTID_OK .and. associated(diagnosis), 'a diagnosis')
    if (associated(diagnosis)) call check(diagnosis%interrupted /= 0, 'that it was interrupted')
    call rotid_free(diagnosis)
    call rotid_free(deck)
    call check(.not. associated(deck), 'a deck that is freed')

    call check(rotid_read_deck(good // '   ', deck, override=[character(len=30) :: 'FIT.HOLDOUT=4', 'NOISE.FREQUENCY=0.01']) &
               == ROTID_OK, 'a deck with options replaced')
    if (associated(deck)) then
      held => rotid_integers(deck%holdout, deck%nmode)
      x => rotid_reals(deck%frequency_std, deck%nmode)
      call check(all(held(1:3) == 0) .and. held(4) /= 0 .and. all(abs(x - 0.01_dp) < 1e-12_dp), 'those options')
    end if
    call rotid_free(deck)

    call texts_as_decks()

    call check(rotid_read_deck(bad, deck, failure=failure) == ROTID_ERROR_SYNTAX, 'a wrong deck')
    call check(index(failure, bad // ':2:') == 1, 'the place of its first mistake')
    if (.not. associated(deck)) return
    message => rotid_messages(deck%message, deck%nmessage)
    call check(size(message) > 0 .and. deck%nerror > 0, 'its messages')
    call check(index(rotid_message_text(message(1)), bad // ':2:') == 1, 'the place of the first one')
    status = rotid_identify_deck(deck, found, failure=failure)
    call check(status == ROTID_ERROR_ARGUMENT .and. .not. associated(found) .and. len(failure) > 0, 'why nothing is identified')
    call rotid_free(found)
    call rotid_free(deck)
  end subroutine decks

  subroutine texts_as_decks()
    character, parameter :: nl = new_line('a')
    character(len=*), parameter :: beam = '*MATERIAL, NAME=steel' // nl // '*ELASTIC' // nl // '2.1e11, 0.3' // nl // &
      '*DENSITY' // nl // '7850' // nl // '*SHAFT, NAME=shaft, MATERIAL=steel' // nl // '1.0, 0.05, 0, 10'
    type(rotid_deck), pointer :: deck
    character(len=:), allocatable :: failure
    call check(rotid_read_deck_text(beam, deck, failure=failure) == ROTID_OK .and. failure == '', 'a text as a deck')
    if (associated(deck)) call check(deck%length == 1 .and. rotid_string(deck%path) == 'deck', 'what it says')
    call rotid_free(deck)
    call check(rotid_read_deck_text(beam // nl // '*INCLUDE, FILE=more.inp', deck, name='beam', failure=failure) &
               == ROTID_ERROR_SYNTAX, 'a text that names a file')
    call check(index(failure, 'beam:8:16: more.inp is a file') == 1, 'that it has none')
    call rotid_free(deck)
    call check(rotid_read_deck_text(beam // nl // '*INCLUDE, FILE=more.inp', deck, name='beam', directory='/nowhere', &
                                    override=['SHAFT.NAME=core'], failure=failure) == ROTID_ERROR_SYNTAX, &
               'a file that is not there')
    call check(index(failure, '/nowhere/more.inp') > 0, 'where it is looked for')
    call rotid_free(deck)
  end subroutine texts_as_decks

end program fortran_host
