# The kernel's CAN, and our source's own tests on it.
check "kernel modules of virtual CAN" modprobe -a vcan can-raw
gtest drivers_socketcan_test
