! A 3-D frame that Fortran assembles, whose modes do not fit: rotid_diagnose_model says which post has lost stiffness. The measured
! modes are made here, with noise, from the frame with a post at 60 % of its stiffness.
module tower
  use rotid
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none

  integer, parameter :: dp = c_double
  ! Two storeys on four posts, 0.40 m by 0.30 m apart and clamped at the foot; u, v, w and three rotations of each node above.
  integer, parameter :: floors = 2, posts = 4, members = 9 * floors, n = 6 * posts * floors, kd = 35
  integer, parameter :: modes = 6, sensors = 2 * posts * floors, suspects = posts * floors
  real(dp), parameter :: side(3) = [0.40_dp, 0.30_dp, 0.50_dp], area = 3e-4_dp, bend = 3e-8_dp, twist = 6e-8_dp, rho = 7850, &
                         nu = 0.3_dp

  type bar
    integer :: dof(12)               ! from 1; zero or less: held
    integer :: modulus               ! of x: 1 of the posts, 2 of the others
    real(dp) :: k(12, 12), m(12, 12) ! for E = 1
  end type bar

  ! What the callbacks need to know; they get its address as `user`.
  type frame
    type(bar) :: bar(members)
  end type frame

contains

  pure function place(node) result(at)
    integer, intent(in) :: node ! from 0, four each floor
    real(dp) :: at(3)
    integer :: post
    post = mod(node, posts)
    at = side * [merge(1, 0, post == 1 .or. post == 2), merge(1, 0, post > 1), node / posts]
  end function place

  ! A tube from node a to node b: a rod, a shaft, and an Euler-Bernoulli beam in two planes, turned into x, y, z.
  pure function bar_between(a, b) result(new)
    integer, intent(in) :: a, b
    type(bar) :: new
    real(dp) :: t(12, 12), axis(3, 3), l, s(4, 4), m(4, 4), sign(4)
    integer :: i, plane, dof(4)
    axis(1, :) = place(b) - place(a)
    l = norm2(axis(1, :))
    axis(1, :) = axis(1, :) / l
    axis(2, :) = merge([axis(1, 3), 0.0_dp, -axis(1, 1)], [axis(1, 2), -axis(1, 1), 0.0_dp], abs(axis(1, 3)) > 0.9_dp)
    axis(2, :) = axis(2, :) / norm2(axis(2, :)) ! any direction across: the section is round
    axis(3, :) = cshift(axis(1, :), 1) * cshift(axis(2, :), 2) - cshift(axis(1, :), 2) * cshift(axis(2, :), 1)
    t = 0
    do i = 1, 10, 3
      t(i:i + 2, i:i + 2) = axis
    end do
    new%k = 0
    new%m = 0
    do i = 1, 4, 3 ! along, and about the axis
      new%k([i, i + 6], [i, i + 6]) = merge(area, twist / (2 * (1 + nu)), i == 1) / l * reshape([1, -1, -1, 1], [2, 2])
      new%m([i, i + 6], [i, i + 6]) = merge(area, twist, i == 1) * rho * l / 6 * reshape([2, 1, 1, 2], [2, 2])
    end do
    s = bend / l**3 * reshape([12.0_dp, 6 * l, -12.0_dp, 6 * l, 6 * l, 4 * l**2, -6 * l, 2 * l**2, &
                               -12.0_dp, -6 * l, 12.0_dp, -6 * l, 6 * l, 2 * l**2, -6 * l, 4 * l**2], [4, 4])
    m = rho * area * l / 420 * reshape([156.0_dp, 22 * l, 54.0_dp, -13 * l, 22 * l, 4 * l**2, 13 * l, -3 * l**2, &
                                        54.0_dp, 13 * l, 156.0_dp, -22 * l, -13 * l, -3 * l**2, -22 * l, 4 * l**2], [4, 4])
    do plane = 1, 2
      dof = [1, 7, 7, 13] + [plane, -plane, plane, -plane]
      sign = [1, merge(1, -1, plane == 1), 1, merge(1, -1, plane == 1)] ! a rotation about y is -dw/dx
      new%k(dof, dof) = s * spread(sign, 1, 4) * spread(sign, 2, 4)
      new%m(dof, dof) = m * spread(sign, 1, 4) * spread(sign, 2, 4)
    end do
    new%k = matmul(transpose(t), matmul(new%k, t))
    new%m = matmul(transpose(t), matmul(new%m, t))
    new%dof = [(6 * (a - posts) + i, i = 1, 6), (6 * (b - posts) + i, i = 1, 6)]
    new%modulus = merge(1, 2, b - a == posts)
  end function bar_between

  ! The posts first, then the ring and one diagonal of each floor.
  pure function whole_frame() result(new)
    type(frame) :: new
    integer :: f, p
    do f = 1, floors
      do p = 0, posts - 1
        new%bar(posts * (f - 1) + p + 1) = bar_between(posts * (f - 1) + p, posts * f + p)
        new%bar(suspects + posts * (f - 1) + p + 1) = bar_between(posts * f + min(p, mod(p + 1, posts)), &
                                                                  posts * f + max(p, mod(p + 1, posts)))
      end do
      new%bar(2 * suspects + f) = bar_between(posts * (f - 1), posts * f + 1)
    end do
  end function whole_frame

  function matrices(user, x, stiffness, mass) result(failure) bind(C)
    type(c_ptr), value :: user
    real(dp), intent(in) :: x(*)
    type(rotid_matrix), intent(inout), target :: stiffness, mass
    integer(c_int) :: failure
    type(frame), pointer :: all
    integer :: i
    call c_f_pointer(user, all)
    do i = 1, members
      failure = rotid_add_element(stiffness, all%bar(i)%dof, x(all%bar(i)%modulus) * all%bar(i)%k)
      if (failure == ROTID_OK) failure = rotid_add_element(mass, all%bar(i)%dof, all%bar(i)%m)
      if (failure /= ROTID_OK) return
    end do
  end function matrices

  ! A cause: the post `user` without the share value(1) of its stiffness.
  function lose(user, x, value, stiffness, mass) result(failure) bind(C)
    type(c_ptr), value :: user
    real(dp), intent(in) :: x(*), value(*)
    type(rotid_matrix), intent(inout), target :: stiffness, mass
    integer(c_int) :: failure
    type(bar), pointer :: post
    call c_f_pointer(user, post)
    failure = rotid_add_element(stiffness, post%dof, -value(1) * x(post%modulus) * post%k)
  end function lose

  ! Normal: a sum of twelve even numbers from Lehmer's generator, the same on every machine
  real(dp) function noise(state)
    integer(int64), intent(inout) :: state
    integer :: i
    noise = -6
    do i = 1, 12
      state = mod(16807 * state, 2147483647_int64)
      noise = noise + real(state, dp) / 2147483647
    end do
  end function noise

end module tower

program tower_diagnosis
  use tower
  implicit none

  type(frame), target :: all
  type(rotid_model) :: model
  type(rotid_measured) :: measured
  type(rotid_host_cause) :: cause(suspects)
  type(rotid_parameter), target :: moduli(2), share
  type(rotid_host_diagnosis), pointer :: found
  type(rotid_host_explanation), pointer :: lead
  type(c_ptr) :: result
  integer(c_int), target :: number(modes), master(sensors)
  real(dp), target :: hz(modes), hz_std(modes), shape(sensors, modes), shape_std(sensors, modes), expected = 0.3_dp
  real(dp), target :: band(kd + 1, n, 2) = 0
  real(dp) :: lambda(modes), phi(n, modes)
  real(dp), pointer :: probability(:), mean(:), lower(:), upper(:)
  character(kind=c_char), target :: failure(ROTID_FAILURE_LENGTH)
  character(len=5), target :: name = 'post' // c_null_char
  type(rotid_matrix), target :: k, m
  integer(int64) :: state = 20261128
  integer :: i, j

  all = whole_frame()
  master(1::2) = [(6 * i, i = 0, posts * floors - 1)] ! from 0: along x and y at every node
  master(2::2) = master(1::2) + 1

  ! What was measured: post 6 without 40 %; frequencies good to 0.05 %, shapes to 1 % of the largest component.
  k = rotid_matrix(n=n, kd=kd, band=c_loc(band(1, 1, 1)))
  m = rotid_matrix(n=n, kd=kd, band=c_loc(band(1, 1, 2)))
  if (matrices(c_loc(all), [2.05e11_dp, 1.9e11_dp], k, m) /= ROTID_OK) error stop 'the frame has no matrices'
  if (lose(c_loc(all%bar(6)), [2.05e11_dp, 1.9e11_dp], [0.4_dp], k, m) /= ROTID_OK) error stop 'the post has no matrices'
  if (rotid_eigenpairs(k, m, modes, c_null_ptr, c_null_ptr, lambda, phi) /= ROTID_OK) error stop 'the frame has no modes'
  do j = 1, modes
    hz(j) = sqrt(lambda(j)) / 6.283185307179586_dp * (1 + 5e-4_dp * noise(state))
    do i = 1, sensors
      shape(i, j) = phi(master(i) + 1, j) / maxval(abs(phi(master + 1, j))) + 0.01_dp * noise(state)
    end do
  end do

  number = [(j, j = 1, modes)]
  hz_std = 5e-4_dp
  shape_std = 0.01_dp
  measured = rotid_measured(nmode=modes, number=c_loc(number), frequency_hz=c_loc(hz), frequency_std=c_loc(hz_std), &
                            shape=c_loc(shape), shape_std=c_loc(shape_std))
  model = rotid_model(n=n, kd=kd, nparam=2, nmaster=sensors, master=c_loc(master), matrices=c_funloc(matrices), user=c_loc(all))
  moduli = rotid_parameter(lower=1e11_dp, upper=3e11_dp, start=2e11_dp)
  share = rotid_parameter(lower=0, upper=0.95_dp, start=0.1_dp)
  do i = 1, suspects
    cause(i) = rotid_host_cause(name=c_loc(name), nparameter=1, parameter=c_loc(share), deviation=c_loc(expected), &
                                add=c_funloc(lose), user=c_loc(all%bar(i)))
  end do
  if (rotid_diagnose_model(model, moduli, measured, suspects, cause, c_null_ptr, c_null_ptr, c_loc(failure), result) &
      /= ROTID_OK) then
    print '(2a)', 'failed: ', rotid_string(c_loc(failure))
    error stop 1
  end if

  call c_f_pointer(result, found)
  call c_f_pointer(found%explanation, lead) ! the likeliest one
  probability => rotid_reals(found%probability, found%ncause)
  mean => rotid_reals(found%mean, 2)
  lower => rotid_reals(found%ci_lower, 2)
  upper => rotid_reals(found%ci_upper, 2)
  print '(a, f5.3, a, f5.3)', 'nothing ', found%nothing, ', something else ', found%something_else
  do i = 1, suspects
    if (probability(i) > 0.01_dp) print '(a, i0, a, f5.3)', 'post ', i, ': probability ', probability(i)
  end do
  do i = 1, lead%ncause
    print '(a, f5.3, a, f5.3)', 'its share: ', lead%value(4 * i - 3), ' +- ', lead%std(4 * i - 3)
  end do
  do i = 1, 2
    print '(a, i0, a, es10.4, a, es10.4, a, es10.4)', 'E', i, ' = ', mean(i), ', 95 % interval ', lower(i), ' ... ', upper(i)
  end do
  call rotid_host_diagnosis_free(result)
end program tower_diagnosis
