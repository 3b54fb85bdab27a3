# Bakes on the ranks of an MPI world. Skipped where there is no MPI, or it cannot start processes here.
foreach(case same_bytes killed signals full_disk refused)
  if(TARGET afterglow_mpi)
    add_test(NAME mpi.${case} COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/mpi.sh ${case} $<TARGET_FILE:afterglow> $<TARGET_FILE:afterglow_mpi>)
    # Open MPI leaves memory when it ends.
    set_tests_properties(mpi.${case} PROPERTIES
      ENVIRONMENT "ASAN_OPTIONS=${ag_asan_options};LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_LIST_DIR}/lsan.supp,print_suppressions=0")
  else()
    add_test(NAME mpi.${case} COMMAND sh -c "echo 'skipped: built without MPI (libopenmpi-dev)'; exit 77")
  endif()
  set_tests_properties(mpi.${case} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600 LABELS mpi RUN_SERIAL TRUE)
endforeach()
set(mpi_program "")
if(TARGET afterglow_mpi)
  set(mpi_program $<TARGET_FILE:afterglow_mpi>)
endif()
add_test(NAME mpi.slurm COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/slurm.sh ${CMAKE_SOURCE_DIR} $<TARGET_FILE:afterglow>
  ${mpi_program})
set_tests_properties(mpi.slurm PROPERTIES TIMEOUT 300 LABELS mpi)
