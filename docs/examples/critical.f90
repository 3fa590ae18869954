! The machine behind *RUNNING: its critical speeds, and where their doubt comes from.
program critical
  use rotid
  implicit none

  type(rotid_deck), pointer :: deck
  type(rotid_speeds), pointer :: found
  type(rotid_critical_speed), pointer :: speed(:)
  type(rotid_variance_share), pointer :: share(:)
  type(rotid_speeds_options) :: options
  character(len=:), allocatable :: failure
  character(len=1000) :: path
  integer :: i, j

  call get_command_argument(1, path)
  if (rotid_read_deck(trim(path), deck) /= ROTID_OK) error stop 'the deck has errors: rotid check says which'
  options%draws = 400
  if (rotid_speeds_deck(deck, found, options, failure=failure) /= ROTID_OK) then
    print '(a)', failure
    error stop 1
  end if
  call c_f_pointer(found%critical_speeds, speed, [found%ncritical_speeds])
  do i = 1, size(speed)
    print '(i0, 1x, a, 1x, i0, a, i0, a)', speed(i)%number, rotid_string(speed(i)%whirl), nint(speed(i)%speed_rpm), &
      ' rpm, standard deviation ', nint(speed(i)%std), ' rpm'
    call c_f_pointer(speed(i)%variance_shares, share, [speed(i)%nvariance_shares])
    do j = 1, size(share)
      print '(4x, f5.1, 2a)', 100 * share(j)%share, ' % by ', rotid_string(share(j)%source)
    end do
  end do
  call rotid_free(found)
  call rotid_free(deck)
  deallocate (failure) ! gfortran keeps what the main program has
end program critical
